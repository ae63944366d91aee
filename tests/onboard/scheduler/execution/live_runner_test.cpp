// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/live_runner.hpp"

#include <gtest/gtest.h>

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

/// Every third tick has work. The one that ends the run is still running at some of the next releases.
struct BusyTask final : Task {
  void tick(Tick& tick) override {
    ++ticks;
    if (tick.index() % 3 == 0) tick.slot(0) = 1;
    if (ticks == 50 && ends) tick.end_of_input();
    if (ticks == kLast) LiveClock::wait_until(tick.release() + 50ms);
  }
  static constexpr std::uint64_t kLast = 31;
  RelaxedCounter ticks;
  bool ends = false;
};

struct LiveRunnerTest : ::testing::Test {
  BusyTask worker;
  TaskGraph graph;
  LiveClock clock;
};

TEST_F(LiveRunnerTest, EveryReleaseIsServedOrCountedAndBusyTicksGoToTheLog) {
  ScheduledTask& task = graph.add({.name = "worker", .rate_hz = 500}, worker);
  run_live(graph, {clock.now(), [this] { return worker.ticks >= BusyTask::kLast; }}, clock, nullptr);
  EXPECT_EQ(task.stats.ticks, worker.ticks);
  EXPECT_EQ(task.stats.ticks + task.stats.slips, task.next);
  EXPECT_EQ(task.stats.response.count(), worker.ticks);
  EXPECT_EQ(task.unlogged, 0U);
  std::uint64_t logged = 0;
  for (; const TickRecord* record = task.log.front(); task.log.pop(), ++logged) {
    EXPECT_FALSE(record->idle());
    EXPECT_TRUE(record->index % 3 == 0 || record->skipped > 0);
  }
  EXPECT_GE(logged, 10U);
}

TEST_F(LiveRunnerTest, EndsByItselfWhenTheInputsHaveEnded) {
  worker.ends = true;
  const ScheduledTask& task = graph.add({.name = "worker", .rate_hz = 500}, worker, TaskRole::kInput);
  run_live(graph, {clock.now(), [] { return false; }}, clock, nullptr);
  EXPECT_NE(task.ended_at(), Time::max());
  EXPECT_GE(worker.ticks, 50U);
}

}  // namespace
}  // namespace cairn::scheduler
