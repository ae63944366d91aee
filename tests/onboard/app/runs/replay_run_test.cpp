// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/replay_run.hpp"

#include <gmock/gmock.h>

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

class NoPackets final : public Source {
 public:
  Result<Poll> next(Packet& /*packet*/, Duration /*timeout*/) override { return Poll::kEnd; }
};

struct ReplayRunTest : ::testing::Test {
  ReplayRunTest() {
    options.recording = "a recording";
    options.pace = Pace::kMaximum;
    Input& input = door.inputs.emplace_back();
    input.entry.kind = recording::kCamera;
    input.source = std::make_unique<NoPackets>();
    door.recording.sources.push_back(input.entry);
  }
  Result<RunEnd> replay() {
    tasks.emplace(door.recording.sources, profile, options, previous, Sight(), monitor);
    return replay_recording(*tasks, {door, profile, options, previous, monitor});
  }
  /// Of a version without the task `rejoin`. Idle, but for the first tick of the receive task, which took a packet.
  scheduler::ScheduleLog log() {
    scheduler::ScheduleLog log;
    for (const scheduler::TaskSpec& spec : {profile.schedule.safety, profile.schedule.drive, profile.schedule.receive,
                                            profile.schedule.odometry, profile.schedule.mapping})
      log.tasks.push_back({spec.name, {Time{1s}, spec.period()}, {}, 1});
    log.tasks[2].ticks.push_back({.index = 0, .slots = {1}});
    return log;
  }

  Door door;
  RobotProfile profile;
  RunOptions options;
  PreviousRun previous;
  Monitor monitor;
  std::optional<RobotTasks> tasks;
};

TEST_F(ReplayRunTest, AnEmptyRecordingEndsByItself) {
  const auto end = replay();
  EXPECT_TRUE(end && *end == RunEnd::kComplete);
  for (const Event& event : monitor.events()) EXPECT_NE(event.stage, "schedule");
}

TEST_F(ReplayRunTest, APacketThatTheLogKnowsAndTheRecordingLacksIsAnEvent) {
  door.schedule = log();
  EXPECT_TRUE(replay());
  ASSERT_FALSE(monitor.events().empty());
  EXPECT_EQ(monitor.events().back().stage, "schedule");
}

TEST_F(ReplayRunTest, AStopBeforeTheEndIsAnInterruption) {
  options.stop = [] { return true; };
  const auto end = replay();
  EXPECT_TRUE(end && *end == RunEnd::kInterrupted);
}

TEST_F(ReplayRunTest, TheLogOfAnotherScheduleIsRefused) {
  door.schedule = log();
  profile.schedule.odometry.rate_hz = 50;
  const auto refused = replay();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::app
