// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/telling.hpp"

#include <gtest/gtest.h>

#include "tests/support/local_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

using namespace std::chrono_literals;

class TellingTest : public testing::Test {
 protected:
  TellingTest() {
    scheduler::TaskSpec spec;
    spec.name = "odometry";
    spec.rate_hz = 10;
    spec.deadline_ms = 90;
    spec.soft_ms = 40;
    line_ = &executive_.add(spec);
    executive_.add(spec).live_only = true;
  }
  void run(Telling& telling, int steps, bool alive) {
    for (int i = 0; i < steps; ++i) {
      if (alive) ++line_->stats.ticks;
      well_ = telling.tick(now_ += 50ms);
    }
  }

  support::TemporaryFolder folder_;
  Monitor monitor_;
  scheduler::Executive executive_;
  scheduler::Line* line_;
  Time now_{100s};
  bool well_ = true;
};

TEST_F(TellingTest, TheViewHoldsTheTasksTheModeAndTheEvents) {
  Telling telling(executive_, monitor_, {"husky", {}, {}, {}}, now_);
  line_->stats.response.record(12ms);
  line_->stats.ticks = 5;
  line_->stats.misses = 1;
  line_->stats.soft_overruns = 2;  // of which one was above the hard budget, too
  line_->stats.hard_overruns = 1;
  monitor_.event(now_, "lidar", "late");
  FailsafeDecision decision;
  decision.mode = Mode::kHold;
  decision.cause = Fault::kLidarSilent;
  decision.active = {Fault::kLidarLate, Fault::kLidarSilent};
  decision.epoch = 3;
  telling.set_decision(decision);
  telling.set_shed(Shed::kMapDensity);
  telling.set_scans(834);
  const LiveView v = telling.view(now_);
  ASSERT_EQ(v.stages.size(), 2U);
  EXPECT_NEAR(v.stages[0].p99_ms, 12, 0.1);
  EXPECT_EQ(v.stages[0].misses, 1U);
  EXPECT_EQ(v.stages[0].deadline_ms, 90);
  EXPECT_EQ(v.stages[0].budget_ms, 40);
  EXPECT_EQ(v.stages[0].overruns, 2U);
  EXPECT_EQ(v.scans, 834U);
  EXPECT_EQ(v.mode, "hold");
  EXPECT_EQ(v.cause, "lidar_silent");
  EXPECT_EQ(v.faults, (std::vector<std::string>{"lidar_late", "lidar_silent"}));
  EXPECT_EQ(v.shed, "map_density");
  EXPECT_EQ(v.events.back().what, "late");
}

TEST_F(TellingTest, ALevelThatLeavesNothingOutIsNotToldAsShed) {
  Telling telling(executive_, monitor_, {"husky", {}, {}, {}}, now_);
  for (const Shed level : {Shed::kPeerTiles, Shed::kSemantics}) {
    telling.set_shed(level);
    EXPECT_EQ(telling.view(now_).shed, "nothing");
  }
}

TEST_F(TellingTest, OneLinePerSecondAndSignsOfLifeWhileAllIsWell) {
  support::DatagramListener manager((folder_ / "notify").string());
  Telling telling(executive_, monitor_, {"husky", folder_ / "live", (folder_ / "notify").string(), 1s}, now_);
  EXPECT_EQ(manager.next(), "READY=1");
  support::StreamClient viewer(folder_ / "live");
  run(telling, 60, true);
  EXPECT_TRUE(well_);
  const std::string seen = viewer.read();
  EXPECT_EQ(std::count(seen.begin(), seen.end(), '\n'), 3);
  EXPECT_NE(manager.next().find("WATCHDOG=1"), std::string::npos);
  run(telling, 40, false);
  EXPECT_FALSE(well_);
  EXPECT_EQ(monitor_.events().back().what, "task odometry hangs");
}

TEST_F(TellingTest, WhatCannotBeOpenedIsAnEvent) {
  Telling telling(executive_, monitor_, {"husky", folder_ / "no" / "folder", "relative", {}}, now_);
  EXPECT_EQ(monitor_.events().size(), 2U);
  run(telling, 20, true);
  EXPECT_TRUE(well_);
}

}  // namespace
}  // namespace cairn
