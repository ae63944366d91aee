// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/robot_tasks.hpp"

#include <algorithm>

#include "onboard/app/tasks/allocations.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn {
namespace {

// A scan may wait while the one before is located; more than a few would only be older when their turn comes.
constexpr std::size_t kWaitingScans = 4;
// Two seconds of a LiDAR.
constexpr std::size_t kWaitingPackets = 2048, kWaitingEdges = 256;
// More news than a safety task that comes late by a tenth of a second could find.
constexpr std::size_t kNews = 64;
// In virtual time: real ones are late by less, and a replay at real speed need not wait for them.
constexpr Duration kNewsLag = std::chrono::milliseconds(20), kNextTick = std::chrono::microseconds(1);
// A large map takes half a second to encode, and the disk its time.
constexpr Duration kSaveLimit = std::chrono::seconds(5);
constexpr Duration kStartIn = std::chrono::milliseconds(50), kLinger = std::chrono::seconds(30);

std::size_t reserve(const RunOptions& options) { return options.live() ? 0 : 3 * kWaitingScans; }

/// The helpers of a stage run as its own thread does: at a lower priority they would hold it up.
std::function<void(unsigned)> like(const scheduler::TaskSpec& task) {
  return [plan = scheduler::ThreadPlan{task.name, task.priority, -1}](unsigned number) {
    scheduler::become({plan.name + "/" + std::to_string(number), plan.priority, plan.core});
  };
}

bool has(const Door& door, std::string_view kind) {
  return std::any_of(door.inputs.begin(), door.inputs.end(), [&](const Input& i) { return i.entry.kind == kind; });
}

/// A chip may serve the camera trigger alone: an e-stop that nobody named cannot be watched.
bool has_estop(const Door& door, const RobotProfile& profile) {
  return has(door, recording::kGpio) && !profile.gpio.driver.estop_line.empty();
}

Fitted fitted(const Door& door, const RobotProfile& profile) {
  Fitted fitted;
  fitted.watched = {has(door, recording::kVelodyne) || has(door, recording::kScans), has(door, recording::kCamera),
                    has(door, recording::kThermal), has(door, recording::kDepth), has(door, recording::kDrive)};
  fitted.drive = has(door, recording::kDrive);
  fitted.estop = has_estop(door, profile);
  return fitted;
}

Result<Recorder> make_recorder(const std::filesystem::path& folder, const recording::Recording& recording,
                               Monitor& monitor) {
  auto writer = recording::RecordingWriter::create(folder, recording);
  if (!writer) return writer.error();
  return Recorder(std::move(*writer), monitor);
}

}  // namespace

RobotTasks::RobotTasks(Door& door, const RobotProfile& profile, const RunOptions& options, const Before& before,
                       Monitor& monitor)
    : door_(door),
      profile_(profile),
      options_(options),
      before_(before),
      monitor_(monitor),
      safety_line_(executive_.add(profile.schedule.safety)),
      drive_line_(executive_.add(profile.schedule.drive)),
      receive_line_(executive_.add(profile.schedule.receive)),
      odometry_line_(executive_.add(profile.schedule.odometry)),
      mapping_line_(executive_.add(profile.schedule.mapping)),
      seen_({kNews, 0, ReceiveTask::kSeenSlot, SafetyTask::kSensorsSlot, kNewsLag}, receive_line_.progress,
            safety_line_.progress),
      drive_news_({kNews, 0, DriveTask::kNewsSlot, SafetyTask::kDriveSlot, kNextTick}, drive_line_.progress,
                  safety_line_.progress),
      odometry_news_(
          {kNews, 0, OdometryTask::kNewsSlot, SafetyTask::kOdometrySlot, 2 * profile.schedule.odometry.deadline()},
          odometry_line_.progress, safety_line_.progress),
      decisions_({kNews, 0, SafetyTask::kDecisionSlot, DriveTask::kDecisionSlot}, safety_line_.progress,
                 drive_line_.progress),
      scans_({kWaitingScans, reserve(options), ReceiveTask::kScansSlot, OdometryTask::kScansSlot},
             receive_line_.progress, odometry_line_.progress),
      motions_({kWaitingScans, reserve(options), OdometryTask::kMotionsSlot, MappingTask::kMotionsSlot},
               odometry_line_.progress, mapping_line_.progress),
      odometry_workers_(static_cast<unsigned>(profile.threads), like(profile.schedule.odometry)),
      mapping_workers_(static_cast<unsigned>(profile.threads), like(profile.schedule.mapping)),
      robot_(before.resumed
                 ? Robot(profile.robot(), odometry_workers_, mapping_workers_, monitor, resume(*before.resumed))
                 : Robot(profile.robot(), odometry_workers_, mapping_workers_, monitor)),
      safety_(profile.failsafe, fitted(door, profile), {seen_, drive_news_, decisions_, odometry_news_}),
      drive_(decisions_, drive_news_),
      receive_(scans_, seen_, monitor),
      odometry_(profile, {scans_, motions_, odometry_news_}, robot_, monitor, options.progress),
      mapping_(profile.overload, profile.schedule.mapping.deadline(), motions_, robot_, monitor) {
  safety_line_.task = &safety_;
  drive_line_.task = &drive_;
  receive_line_.task = &receive_;
  odometry_line_.task = &odometry_;
  mapping_line_.task = &mapping_;
  safety_line_.input = drive_line_.input = receive_line_.input = true;
  safety_line_.from = {&seen_, &drive_news_, &odometry_news_};
  drive_line_.from = {&decisions_};
  odometry_line_.from = {&scans_};
  mapping_line_.from = {&motions_};
  if (has(door, recording::kPeers)) {
    team_.emplace(executive_, profile, mapping_line_, MappingTask::kTilesSlot, monitor);
    if (before_.resumed) team_->team().go_on();
    mapping_.share_tiles(team_->tiles());
  }
  executive_.count_allocations(allocations_of_this_thread);
  if (options.reference) add_live_only(profile.schedule.safety, reference_).spec.name = "reference";
}

scheduler::Line& RobotTasks::add_live_only(const scheduler::TaskSpec& spec, scheduler::Task& task) {
  scheduler::Line& line = executive_.add(spec);
  line.task = &task;
  line.live_only = true;
  return line;
}

Result<void> RobotTasks::connect(Recorder* recorder) {
  const auto tap = [recorder](std::size_t packets, std::size_t bytes) {
    return recorder != nullptr ? recorder->tap(packets, bytes) : scheduler::Feed::Tap{};
  };
  const auto received = tap(kWaitingPackets, 0);
  for (std::size_t i = 0; i < door_.inputs.size(); ++i) {
    Input& input = door_.inputs[i];
    const auto id = static_cast<SourceId>(i);
    if (input.entry.kind == recording::kGpio && has_estop(door_, profile_)) {
      safety_.watch_estop(profile_.gpio.driver, *input.source, id, input.lines,
                          tap(kWaitingEdges, scheduler::Feed::kSmall));
    } else if (input.entry.kind == recording::kDrive) {
      if (const auto attached = drive_.attach(profile_.drive.driver, *input.source, id, input.can,
                                              tap(kWaitingPackets, scheduler::Feed::kSmall));
          !attached)
        return attached.error();
    } else if (input.entry.kind == recording::kPeers) {
      team_->team().attach(*input.source, id, input.peers, tap(kWaitingPackets, peers::kMaxPacket));
    } else if (!receive_.add(input, id, received)) {
      monitor_.event({}, "input", "more sources than are read: " + input.entry.id + " is left out");
    }
  }
  return {};
}

/// What the safety task may not say itself.
void RobotTasks::note_changes() {
  for (; const SafetyTask::Change* change = safety_.changes().front(); safety_.changes().pop()) {
    for (const FaultRow& row : fault_table()) {
      if (change->raised.has(row.fault)) monitor_.event(change->at, "safety", "fault: " + std::string(row.code));
      if (change->ended.has(row.fault)) monitor_.event(change->at, "safety", "ended: " + std::string(row.code));
    }
    monitor_.event(change->at, "safety", "mode: " + std::string(to_string(change->mode)));
    noted_.mode = change->mode;
    noted_.cause = change->cause;
    noted_.active = change->active;
    noted_.epoch = change->epoch;
  }
}

void RobotTasks::tell(Telling& telling, FaultSet faults, Time now) {
  telling.set_decision(noted_);
  telling.set_shed(mapping_.shed());
  telling.set_scans(receive_.figures().scans);
  if (team_ && team_->team().view().refresh()) telling.set_peers(team_->team().view().value());
  faults = faults | schedule_faults_.look();
  faults.set(Fault::kTaskHung, !telling.tick(now));
  faults.set(Fault::kBestEffort, best_effort_);
  faults.set(Fault::kCrashLoop, before_.crash_loop);
  faults.set(Fault::kStateLost, before_.state_lost);
  faults.set(Fault::kOverload, mapping_.shed() != Shed::kNothing);
  faults.set(Fault::kMemoryShort, mapping_.memory_short());
  safety_.report(faults);
}

/// What real-time operation lacks here is said once; the run goes on in best-effort mode.
void RobotTasks::become_real_time() {
  int highest = 0;
  for (const scheduler::Line& line : executive_.lines()) highest = std::max(highest, line.spec.priority);
  const auto missing = scheduler::probe_privileges(highest);
  best_effort_ = !missing.empty();
  for (const std::string& what : missing) monitor_.event({}, "best effort", "missing: " + what);
  if (!scheduler::lock_memory() && !best_effort_) monitor_.event({}, "best effort", "memory cannot be locked");
}

Time RobotTasks::first_arrival() {
  const Time team = team_ ? team_->team().first_arrival() : Time::max();
  return std::min({safety_.first_arrival(), drive_.first_arrival(), receive_.first_arrival(), team});
}

Pulse RobotTasks::add_saving(SavingTask& saving) {
  const scheduler::Line& line = add_live_only(profile_.schedule.saving, saving);
  odometry_.tell(to_save_.pose);
  ScanSelection selection;
  if (before_.resumed) {
    saving.go_on_with(before_.resumed->scans);
    selection = ScanSelection(before_.resumed->scans.back().T_odom_base);
  }
  mapping_.keep_copies({profile_.odometry, from_seconds(profile_.restart.save_map_every_s), selection, to_save_});
  return {line.spec.name, kSaveLimit, &line.stats.ticks};
}

Result<std::optional<Recorder>> RobotTasks::open_recorder() {
  if (options_.record.empty()) return std::optional<Recorder>();
  auto recorder = make_recorder(options_.record, door_.recording, monitor_);
  if (!recorder) return recorder.error();
  if (before_.resumed)
    if (const auto kept = keep_with_recording(options_.record, *before_.resumed, monitor_); !kept) return kept.error();
  return std::optional<Recorder>(std::move(*recorder));
}

/// A recording that is played among peers has ended, and they had time to hear of it.
bool RobotTasks::played_out(Time now) const {
  if (options_.recording.empty() || options_.seconds) return false;
  const Time end = std::max({safety_line_.ended_at(), drive_line_.ended_at(), receive_line_.ended_at()});
  return end != Time::max() && now > end + kLinger;
}

Result<void> RobotTasks::run_live(const Clock& clock, Generations* generations) {
  auto opened = open_recorder();
  if (!opened) return opened.error();
  Recorder* recorder = *opened ? &**opened : nullptr;
  if (const auto connected = connect(recorder); !connected) return connected.error();
  HousekeepingTask housekeeping(executive_, (recorder != nullptr ? options_.record : options_.out) / "schedule.log",
                                recorder);
  const scheduler::Line& keeping = add_live_only(profile_.schedule.housekeeping, housekeeping);
  std::vector<Pulse> writers{{keeping.spec.name, WatchTask::kDiskLimit, &keeping.stats.ticks}};
  std::optional<SavingTask> saving;
  if (generations != nullptr)
    writers.push_back(add_saving(saving.emplace(*generations, to_save_, before_.epoch, boot_id(), monitor_)));
  WatchTask watch(std::move(writers), recorder);
  add_live_only(profile_.schedule.watch, watch);
  Telling telling(executive_, monitor_, Telling::from_environment(profile_.name, options_.live_view), clock.now());
  watch.add([this](Time) { note_changes(); });
  watch.add([&](Time now) {
    FaultSet faults = watch.faults();
    if (saving && saving->failing()) faults.set(Fault::kDiskFailing, true);
    tell(telling, faults, now);
  });
  become_real_time();
  const Time start = clock.now() + kStartIn;
  const Duration length = options_.seconds ? from_seconds(*options_.seconds) : Duration::max();
  const auto ended = [&](Time now) { return (options_.stop && options_.stop()) || now - start > length; };
  executive_.run_live({start, [&] { return ended(clock.now()) || played_out(clock.now()); }}, clock);
  note_changes();
  if (saving) saving->close(clock.now(), robot_);
  say_what_is_missing(clock.now());
  return housekeeping.close(clock.now());
}

void RobotTasks::say_what_is_missing(Time now) {
  for (const scheduler::Line& line : executive_.lines())
    if (line.unlogged > 0)
      monitor_.event(now, "schedule", line.spec.name + ": ticks are missing in the log: not to be replayed to the bit");
}

Result<void> RobotTasks::replay() {
  if (const auto connected = connect(nullptr); !connected) return connected.error();
  const LiveClock clock;
  scheduler::Executive::ReplayOptions options;
  const Time first = first_arrival();
  options.start = first == Time::max() ? Time{} : first;
  options.log = door_.schedule ? &*door_.schedule : nullptr;
  options.pace = options_.pace == Pace::kRecorded ? &clock : nullptr;
  if (options_.seconds) options.length = from_seconds(*options_.seconds);
  if (options.pace != nullptr) become_real_time();
  if (const auto done = executive_.run_replay(options); !done) return done.error();
  note_changes();
  const auto missing_of_team = team_ ? team_->team().missing_packets() : 0;
  if (executive_.diverged() || receive_.missing_packets() + drive_.missing_packets() + missing_of_team > 0)
    monitor_.event(figures().end, "schedule", "the recording lacks packets that the live run had: not the same result");
  return {};
}

}  // namespace cairn
