// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/threaded_replay.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/scheduler/execution/pipeline.hpp"
#include "tests/onboard/scheduler/list_source.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

struct BesideTask final : Task {
  void tick(Tick& tick) override {
    live = tick.regime() == Regime::kLive;
    ++ticks;
  }
  bool live = false;
  RelaxedCounter ticks;
};

struct ThreadedReplayTest : ::testing::Test {
  void replay() {
    const auto schedule = ReplaySchedule::prepare(pipeline.graph, {.start = Time{1s}});
    ASSERT_TRUE(schedule);
    const LiveClock clock;
    EXPECT_FALSE(replay_on_threads(*schedule, Time{1s}, clock, nullptr).interrupted);
  }
  test::ListSource source{test::arrivals(Time{1s})};
  test::Pipeline pipeline{source};
};

TEST_F(ThreadedReplayTest, MeasuresWhatItRan) {
  replay();
  const TaskStats& s = pipeline.sinking.stats;
  EXPECT_GT(s.ticks, 90U);
  EXPECT_EQ(s.ticks, s.response.count());
  EXPECT_GE(s.response.max(), s.execution.max());
}

TEST_F(ThreadedReplayTest, WhatIsLiveOnlyRunsBesideItOnTheMachinesClock) {
  BesideTask beside;
  pipeline.graph.add({.name = "beside", .rate_hz = 500}, beside, TaskRole::kLiveOnly);
  replay();
  EXPECT_GT(beside.ticks, 0U);
  EXPECT_TRUE(beside.live);
}

}  // namespace
}  // namespace cairn::scheduler
