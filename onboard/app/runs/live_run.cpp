// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/live_run.hpp"

#include <algorithm>

#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/app/runs/allocations.hpp"
#include "onboard/app/runs/connect_inputs.hpp"
#include "onboard/app/runs/real_time.hpp"
#include "onboard/app/runs/shown_cameras.hpp"
#include "onboard/app/sight/open_thermal.hpp"
#include "onboard/scheduler/execution/executive.hpp"

namespace cairn::app {
namespace {

// A large map takes half a second to encode, and the disk its time.
constexpr Duration kSavingLimit = std::chrono::seconds(5);
// From here to the first release: every thread is waiting by then.
constexpr Duration kStartDelay = std::chrono::milliseconds(50);
// A recording that is played among peers has ended, and they get the time to hear of it.
constexpr Duration kLinger = std::chrono::seconds(30);

/// What clients are told first.
clients::HelloMessage greeting(const RobotProfile& profile, const std::vector<recording::SourceEntry>& sources,
                               std::uint64_t session) {
  clients::HelloMessage hello{.robot = profile.name,
                              .robot_id = static_cast<std::uint64_t>(profile.team.id),
                              .session = session,
                              .resolution_m = profile.mapping.resolution_m};
  for (const recording::SourceEntry& source : sources)
    if (source.base_sensor_xyz_rpy) hello.sensors.push_back({source.id, source.T_base_sensor()});
  return hello;
}

}  // namespace

LiveRun::LiveRun(RobotTasks& tasks, const RunContext& context, const Clock& clock)
    : tasks_(tasks),
      context_(context),
      clock_(clock),
      safety_events_(tasks.safety, context.monitor),
      schedule_faults_(tasks.graph, tasks.graph.scheduled(tasks.safety)) {}

Result<RunEnd> LiveRun::run(Generations* generations) {
  if (const auto opened = open_recorder(); !opened) return opened.error();
  if (const auto connected = connect_inputs(tasks_, context_, recorder_ ? &*recorder_ : nullptr); !connected)
    return connected.error();
  if (const auto opened = open_streams(); !opened) return opened.error();
  add_live_only_tasks(generations);
  best_effort_ = !become_real_time(tasks_.graph, context_.monitor);
  execute();
  safety_events_.read();
  close_streams();
  if (saving_) saving_->close(clock_.now(), tasks_.robot);
  report_unlogged_ticks();
  if (labels_) labels_->write_waiting(clock_.now());
  if (boxes_) boxes_->close(clock_.now());
  close_log();
  return end();
}

Result<void> LiveRun::open_recorder() {
  const auto& folder = context_.options.record;
  if (folder.empty()) return {};
  auto writer = recording::RecordingWriter::create(folder, context_.door.recording);
  if (!writer) return writer.error();
  if (const auto kept = keep_profile(folder, context_.profile); !kept) return kept.error();
  recorder_.emplace(std::move(*writer), context_.monitor);
  if (const auto kept = keep_labels(folder); !kept) return kept.error();
  if (const auto kept = keep_boxes(folder); !kept) return kept.error();
  if (!context_.previous.resumed) return {};
  return keep_with_recording(folder, *context_.previous.resumed, context_.monitor);
}

Result<void> LiveRun::keep_labels(const std::filesystem::path& folder) {
  if (!tasks_.perception) return {};
  auto opened = LabelRecorder::create(folder, context_.monitor);
  if (!opened) return opened.error();
  labels_ = std::move(*opened);
  tasks_.perception->keep_labels([this](const LabelImage& labels) { labels_->keep(labels); });
  return {};
}

Result<void> LiveRun::keep_boxes(const std::filesystem::path& folder) {
  if (tasks_.detections.empty()) return {};
  auto opened = BoxRecorder::create(folder, context_.monitor);
  if (!opened) return opened.error();
  boxes_ = std::move(*opened);
  for (DetectionTask& task : tasks_.detections) {
    const std::size_t camera = boxes_->add(task.source());
    task.keep_boxes([this, camera](const Detections& boxes) { boxes_->keep(camera, boxes); });
  }
  return {};
}

Result<void> LiveRun::open_streams() {
  const auto& folder = context_.options.sockets;
  if (folder.empty()) return {};
  const RobotProfile& profile = context_.profile;
  const auto robot_id = static_cast<std::uint64_t>(profile.team.id);
  const std::uint64_t session = new_epoch(clock_.now() + LiveClock::realtime_offset());
  auto hub = ClientHub::open(folder, greeting(profile, context_.door.recording.sources, session), context_.monitor);
  if (!hub) return hub.error();
  outlets_.emplace();
  streams_.emplace(std::move(*hub), session, robot_id, *outlets_, context_.monitor);
  tasks_.serve_poses(*outlets_);
  tasks_.drive.publish_to(outlets_->drive);
  tasks_.drive.tell_wheels(*outlets_);
  const auto cameras = shown_cameras(profile, context_.door.recording.sources);
  show(cameras, tasks_.receive, *outlets_);
  streams_->show(cameras);
  show_thermal();
  streams_->set_wheel_radius(profile.drive.driver.wheel_radius_m);
  tasks_.mapping.serve(outlets_->own);
  tasks_.mapping.tell_people(outlets_->people);
  if (!tasks_.team) return {};
  tasks_.team->team().serve(outlets_->team, outlets_->T_team_odom);
  tasks_.team->team().tell_people(outlets_->team_people);
  return {};
}

/// Why there are no thermal clouds is told to those who want them.
void LiveRun::show_thermal() {
  auto parts = open_thermal(context_.profile, context_.door.recording.sources);
  if (!parts) return streams_->show(nullptr, to_string(parts.error()));
  (void)tasks_.receive.show(recording::kThermal, outlets_->thermal);
  streams_->show(std::make_unique<ThermalStream>(std::move(parts->camera), std::move(parts->lifter), context_.monitor),
                 {});
}

/// A disk that cannot keep the schedule costs the exact replay, not the results.
void LiveRun::close_log() {
  const auto closed = housekeeping_->close(clock_.now());
  if (closed) return;
  lost_schedule_ = closed.error();
  context_.monitor.event(clock_.now(), "schedule", to_string(closed.error()));
}

/// The last tiles go out before the clients are left alone.
void LiveRun::close_streams() {
  if (!streams_) return;
  streams_->close(clock_, [this] {
    const bool own = tasks_.mapping.serve_rest();
    return (!tasks_.team || tasks_.team->team().serve_rest()) && own;
  });
  streams_.reset();
}

void LiveRun::add_live_only_tasks(Generations* generations) {
  const RunOptions& options = context_.options;
  const ScheduleProfile& schedule = context_.profile.schedule;
  Recorder* recorder = recorder_ ? &*recorder_ : nullptr;
  housekeeping_.emplace(tasks_.graph, (recorder != nullptr ? options.record : context_.results) / "schedule.log",
                        recorder);
  if (labels_) housekeeping_->add([this](Time now) { labels_->write_waiting(now); });
  if (boxes_) housekeeping_->add([this](Time now) { boxes_->write_waiting(now); });
  const auto& keeping = add_live_only(schedule.housekeeping, *housekeeping_);
  std::vector<safety::Pulse> writers{
      {.task = keeping.spec.name, .limit = WatchTask::kDiskLimit, .beats = &keeping.stats.ticks}};
  if (generations != nullptr) writers.push_back(add_saving(*generations));
  watch_.emplace(std::move(writers), recorder);
  add_live_only(schedule.watch, *watch_);
  if (streams_) add_live_only(schedule.streams, *streams_);
  publisher_.emplace(tasks_.graph, context_.monitor,
                     StatusPublisher::from_environment(context_.profile.name, options.live_view), clock_.now());
  watch_->add([this](Time) { safety_events_.read(); });
  watch_->add([this](Time now) { publish_status(now); });
}

safety::Pulse LiveRun::add_saving(Generations& generations) {
  const RobotProfile& profile = context_.profile;
  const PreviousRun& previous = context_.previous;
  saving_.emplace(generations, to_save_, previous.epoch, boot_id(), context_.monitor);
  const auto& scheduled = add_live_only(profile.schedule.saving, *saving_);
  tasks_.publish_poses_to(to_save_.pose);
  if (tasks_.visual) tasks_.visual->keep_keyframes(to_save_.keyframes);
  odometry::ScanSelection selection;
  if (previous.resumed) {
    saving_->go_on_with(*previous.resumed);
    const auto& scans = previous.resumed->scans;
    if (!scans.empty()) selection = odometry::ScanSelection(scans.back().T_odom_base);
  }
  tasks_.mapping.keep_copies({profile.odometry, from_seconds(profile.restart.save_map_every_s), selection, to_save_});
  return {.task = scheduled.spec.name, .limit = kSavingLimit, .beats = &scheduled.stats.ticks};
}

scheduler::ScheduledTask& LiveRun::add_live_only(const scheduler::TaskSpec& spec, scheduler::Task& task) {
  return tasks_.graph.add(spec, task, scheduler::TaskRole::kLiveOnly);
}

void LiveRun::execute() {
  const RunOptions& options = context_.options;
  const Time start = clock_.now() + kStartDelay;
  const Duration length = options.seconds ? from_seconds(*options.seconds) : Duration::max();
  const auto ended = [&] {
    return (options.stop && options.stop()) || clock_.now() - start > length || played_out(clock_.now());
  };
  scheduler::Executive(tasks_.graph, allocations_of_this_thread).run_live({start, ended}, clock_);
}

Time LiveRun::played_until() const {
  if (context_.options.recording.empty()) return Time::max();
  const auto ended_at = [&](const scheduler::Task& task) { return tasks_.graph.scheduled(task).ended_at(); };
  return std::max({ended_at(tasks_.safety), ended_at(tasks_.drive), ended_at(tasks_.receive)});
}

bool LiveRun::played_out(Time now) const {
  const Time end = context_.options.seconds ? Time::max() : played_until();
  return end != Time::max() && now > end + kLinger;
}

RunEnd LiveRun::end() const {
  const RunOptions& options = context_.options;
  const bool stopped = !options.recording.empty() && options.stop && options.stop();
  return stopped && played_until() == Time::max() ? RunEnd::kInterrupted : RunEnd::kComplete;
}

void LiveRun::publish_status(Time now) {
  publisher_->set_decision(safety_events_.decision());
  publisher_->set_shed(tasks_.mapping.shed_in_force());
  publisher_->set_scans(tasks_.looks());
  if (tasks_.team && tasks_.team->team().view().refresh()) publisher_->set_peers(tasks_.team->team().view().value());
  if (tasks_.robot.follows_people()) publish_people();
  if (outlets_) publish_state();
  safety::FaultSet faults = faults_of_machine() | schedule_faults_.look();
  faults.set(safety::Fault::kTaskHung, !publisher_->tick(now));
  tasks_.safety.report(faults);
}

void LiveRun::publish_people() {
  const PeopleLog& log = tasks_.mapping.people_log();
  const bool anybody = log.now() > 0;
  publisher_->set_people(
      {.now = log.now(), .tracks = log.tracks(), .nearest_m = anybody ? static_cast<double>(log.nearest_now()) : -1});
}

void LiveRun::publish_state() {
  (void)outlets_->drive.refresh();
  (void)outlets_->T_team_odom.refresh();
  outlets_->state.publish(StateNews{.decision = safety_events_.decision(),
                                    .drive = outlets_->drive.value(),
                                    .shed = tasks_.mapping.shed_in_force(),
                                    .scans = tasks_.looks(),
                                    .T_team_odom = outlets_->T_team_odom.value()});
}

safety::FaultSet LiveRun::faults_of_machine() const {
  safety::FaultSet faults = watch_->faults();
  if (housekeeping_->failing() || (saving_ && saving_->failing())) faults.set(safety::Fault::kDiskFailing);
  faults.set(safety::Fault::kBestEffort, best_effort_);
  faults.set(safety::Fault::kCrashLoop, context_.previous.crash_loop);
  faults.set(safety::Fault::kStateLost, context_.previous.state_lost);
  faults.set(safety::Fault::kOverload, tasks_.mapping.shed() != safety::Shed::kNothing);
  faults.set(safety::Fault::kMemoryShort, tasks_.mapping.memory_short());
  return faults;
}

void LiveRun::report_unlogged_ticks() {
  for (const scheduler::ScheduledTask& task : tasks_.graph.tasks())
    if (task.unlogged > 0)
      context_.monitor.event(clock_.now(), "schedule",
                             task.spec.name + ": ticks are missing in the log: not to be replayed to the bit");
}

}  // namespace cairn::app
