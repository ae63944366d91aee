// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/robot_tasks.hpp"

#include "onboard/app/allocations.hpp"
#include "onboard/app/stop_signal.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn {
namespace {

// A scan may wait while the one before is located; more than a few would only be older when their turn comes.
constexpr std::size_t kWaitingScans = 4;
// Two seconds of a LiDAR.
constexpr std::size_t kWaitingPackets = 2048;
constexpr Duration kStartIn = std::chrono::milliseconds(50);

std::size_t reserve(const RunOptions& options) { return options.recording.empty() ? 0 : 3 * kWaitingScans; }

/// The helpers of a stage run as its own thread does: at a lower priority they would hold it up.
std::function<void(unsigned)> like(const scheduler::TaskSpec& task) {
  return [plan = scheduler::ThreadPlan{task.name, task.priority, -1}](unsigned number) {
    scheduler::become({plan.name + "/" + std::to_string(number), plan.priority, plan.core});
  };
}

Result<Recorder> make_recorder(const std::filesystem::path& folder, const recording::Recording& recording,
                               Monitor& monitor) {
  auto writer = recording::RecordingWriter::create(folder, recording);
  if (!writer) return writer.error();
  return Recorder(std::move(*writer), monitor);
}

}  // namespace

RobotTasks::RobotTasks(Door& door, const RobotProfile& profile, const RunOptions& options, Monitor& monitor)
    : door_(door),
      profile_(profile),
      options_(options),
      monitor_(monitor),
      receive_line_(executive_.add(profile.schedule.receive)),
      odometry_line_(executive_.add(profile.schedule.odometry)),
      mapping_line_(executive_.add(profile.schedule.mapping)),
      scans_({kWaitingScans, reserve(options), ReceiveTask::kScansSlot, OdometryTask::kScansSlot},
             receive_line_.progress, odometry_line_.progress),
      motions_({kWaitingScans, reserve(options), OdometryTask::kMotionsSlot, MappingTask::kMotionsSlot},
               odometry_line_.progress, mapping_line_.progress),
      odometry_workers_(static_cast<unsigned>(profile.threads), like(profile.schedule.odometry)),
      mapping_workers_(static_cast<unsigned>(profile.threads), like(profile.schedule.mapping)),
      robot_(profile.robot(), odometry_workers_, mapping_workers_, monitor),
      receive_(scans_, monitor, options.seconds),
      odometry_(profile, scans_, motions_, robot_, monitor, options.progress),
      mapping_(motions_, robot_, monitor) {
  receive_line_.task = &receive_;
  odometry_line_.task = &odometry_;
  mapping_line_.task = &mapping_;
  receive_line_.input = true;
  odometry_line_.from = {&scans_};
  mapping_line_.from = {&motions_};
  executive_.count_allocations(allocations_of_this_thread);
}

void RobotTasks::connect(Recorder* recorder) {
  const auto tap = recorder != nullptr ? recorder->tap(kWaitingPackets) : scheduler::Feed::Tap{};
  for (std::size_t i = 0; i < door_.inputs.size(); ++i)
    if (!receive_.add(door_.inputs[i], static_cast<SourceId>(i), tap))
      monitor_.event({}, "input", "more sources than are read: " + door_.inputs[i].entry.id + " is left out");
}

Result<void> RobotTasks::run_live(const Clock& clock) {
  std::optional<Recorder> recorder;
  if (!options_.record.empty()) {
    auto made = make_recorder(options_.record, door_.recording, monitor_);
    if (!made) return made.error();
    recorder.emplace(std::move(*made));
  }
  connect(recorder ? &*recorder : nullptr);
  HousekeepingTask housekeeping(executive_, (recorder ? options_.record : options_.out) / "schedule.log",
                                recorder ? &*recorder : nullptr);
  scheduler::Line& line = executive_.add(profile_.schedule.housekeeping);
  line.task = &housekeeping;
  line.live_only = true;
  executive_.run_live({clock.now() + kStartIn, stop_requested}, clock);
  return housekeeping.close(clock.now());
}

Result<void> RobotTasks::replay() {
  connect(nullptr);
  const LiveClock clock;
  scheduler::Executive::ReplayOptions options;
  const Time first = receive_.first_arrival();
  options.start = first == Time::max() ? Time{} : first;
  options.log = door_.schedule ? &*door_.schedule : nullptr;
  options.pace = options_.pace == Pace::kRecorded ? &clock : nullptr;
  if (const auto done = executive_.run_replay(options); !done) return done.error();
  if (executive_.diverged() || receive_.missing_packets() > 0)
    monitor_.event(figures().end, "schedule", "the recording lacks packets that the live run had: not the same result");
  return {};
}

}  // namespace cairn
