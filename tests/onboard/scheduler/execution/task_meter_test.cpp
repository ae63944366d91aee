// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/task_meter.hpp"

#include <gtest/gtest.h>

#include "onboard/scheduler/idle_task.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

/// Three in each tick.
std::uint64_t allocations() {
  static std::uint64_t count = 0;
  return count += 3;
}

struct TaskMeterTest : ::testing::Test {
  /// A tick that begins `late` after its release and takes `takes`.
  std::uint64_t tick(Time release, Duration late, Duration takes) {
    clock.advance_to(release + late);
    meter.begin();
    clock.advance_to(release + late + takes);
    return meter.end(release, true);
  }
  IdleTask idle;
  ScheduledTask task{
      {.name = "task", .rate_hz = 10, .deadline_ms = 50, .soft_ms = 10, .hard_ms = 20}, idle, TaskRole::kStage};
  VirtualClock clock;
  TaskMeter meter{task, clock, allocations};
};

TEST_F(TaskMeterTest, TellsWakingExecutionAndResponseApart) {
  tick(Time{1s}, 2ms, 5ms);
  EXPECT_EQ(task.stats.wake.max(), 2ms);
  EXPECT_EQ(task.stats.execution.max(), 5ms);
  EXPECT_EQ(task.stats.response.max(), 7ms);
  EXPECT_EQ(task.stats.misses, 0U);
}

TEST_F(TaskMeterTest, ADeadlineIsMissedByTheResponseAndABudgetByTheExecution) {
  EXPECT_EQ(tick(Time{1s}, 45ms, 6ms), 0U);
  EXPECT_EQ(task.stats.misses, 1U);
  EXPECT_EQ(task.stats.soft_overruns, 0U);
  EXPECT_EQ(tick(Time{2s}, 0ms, 11ms), 0U);
  EXPECT_EQ(task.stats.soft_overruns, 1U);
  EXPECT_EQ(tick(Time{3s}, 0ms, 21ms), 1U) << "a release is left out after a hard overrun";
  EXPECT_EQ(task.stats.hard_overruns, 1U);
}

TEST_F(TaskMeterTest, AllocationsCountAfterTheWarmUp) {
  task.releases.first = Time{1s};
  tick(Time{1s} + TaskMeter::kWarmUp, 0ms, 1ms);
  EXPECT_EQ(task.stats.allocations, 0U);
  tick(Time{1s} + TaskMeter::kWarmUp + 100ms, 0ms, 1ms);
  EXPECT_EQ(task.stats.allocations, 3U);
}

}  // namespace
}  // namespace cairn::scheduler
