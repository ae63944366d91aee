// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/replay_schedule.hpp"

#include <gtest/gtest.h>

#include "onboard/scheduler/execution/run_end.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

struct CountingTask final : Task {
  void tick(Tick& tick) override {
    regime = tick.regime();
    taken = tick.slot(0);
    if (ends) tick.end_of_input();
  }
  Regime regime{};
  std::int32_t taken = 0;
  bool ends = false;
};

struct ReplayScheduleTest : ::testing::Test {
  CountingTask counter;
  TaskGraph graph;
  ScheduledTask& task = graph.add({.name = "task", .rate_hz = 100, .phase_ms = 2}, counter, TaskRole::kInput);
};

TEST_F(ReplayScheduleTest, InVirtualTimeReleasesBeginAtTheStart) {
  const auto schedule = ReplaySchedule::prepare(graph, {.start = Time{1s}});
  ASSERT_TRUE(schedule);
  EXPECT_FALSE(schedule->logged());
  EXPECT_EQ(task.releases.first, Time{1002ms});
  ReplaySchedule::tick(task, nullptr, nullptr);
  EXPECT_EQ(counter.regime, Regime::kVirtual);
  EXPECT_EQ(task.next, 1U);
  EXPECT_TRUE(schedule->inputs_reached(Time{1012ms} - 1ns));
  EXPECT_FALSE(schedule->inputs_reached(Time{1012ms}));
}

TEST_F(ReplayScheduleTest, ItIsOverSoonAfterTheInputHasEnded) {
  const auto schedule = ReplaySchedule::prepare(graph, {.start = Time{1s}});
  ASSERT_TRUE(schedule);
  EXPECT_FALSE(schedule->over(task, Time{100s}));
  counter.ends = true;
  ReplaySchedule::tick(task, nullptr, nullptr);
  EXPECT_FALSE(schedule->over(task, Time{1002ms} + kTail));
  EXPECT_TRUE(schedule->over(task, Time{1002ms} + kTail + 1ns));
}

TEST_F(ReplayScheduleTest, ItIsOverWhenItsLengthIs) {
  const auto schedule = ReplaySchedule::prepare(graph, {.start = Time{1s}, .length = 50ms});
  ASSERT_TRUE(schedule);
  EXPECT_FALSE(schedule->over(task, Time{1050ms}));
  EXPECT_TRUE(schedule->over(task, Time{1050ms} + 1ns));
}

TEST_F(ReplayScheduleTest, ALogGivesReleasesRecordsAndTheEnd) {
  TickRecord busy{.index = 2, .skipped = 1, .slots = {7}};
  const ScheduleLog log{{{"task", {Time{5s}, 10ms}, {busy}, 4}}};
  const auto schedule = ReplaySchedule::prepare(graph, {.start = Time{1s}, .log = &log});
  ASSERT_TRUE(schedule);
  EXPECT_TRUE(schedule->logged());
  EXPECT_EQ(task.releases.first, Time{5s});
  ReplaySchedule::tick(task, nullptr, nullptr);
  EXPECT_EQ(counter.regime, Regime::kLogged);
  EXPECT_EQ(counter.taken, 0) << "the first release was idle";
  ReplaySchedule::tick(task, nullptr, nullptr);
  EXPECT_EQ(counter.taken, 7);
  EXPECT_EQ(task.next, 3U) << "one release was passed";
  EXPECT_FALSE(schedule->over(task, task.releases.at(3)));
  ReplaySchedule::tick(task, nullptr, nullptr);
  EXPECT_TRUE(schedule->over(task, task.releases.at(4)));
}

TEST_F(ReplayScheduleTest, ALogOfOtherTasksIsRefused) {
  const ScheduleLog other_name{{{"other", {Time{5s}, 10ms}, {}, 4}}};
  const ScheduleLog other_period{{{"task", {Time{5s}, 20ms}, {}, 4}}};
  for (const ScheduleLog* log : {&other_name, &other_period}) {
    const auto refused = ReplaySchedule::prepare(graph, {.log = log});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::kInvalidConfig);
  }
}

TEST_F(ReplayScheduleTest, ATaskThatIsLiveOnlyNeedsNoPlaceInTheLog) {
  CountingTask saving;
  graph.add({.name = "saving"}, saving, TaskRole::kLiveOnly);
  const ScheduleLog log{{{"task", {Time{5s}, 10ms}, {}, 4}}};
  EXPECT_TRUE(ReplaySchedule::prepare(graph, {.log = &log}));
}

}  // namespace
}  // namespace cairn::scheduler
