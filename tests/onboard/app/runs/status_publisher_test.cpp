// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/status_publisher.hpp"

#include <gtest/gtest.h>

#include "onboard/scheduler/idle_task.hpp"
#include "tests/support/local_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

class StatusPublisherTest : public testing::Test {
 protected:
  StatusPublisherTest() {
    const scheduler::TaskSpec spec{.name = "odometry", .rate_hz = 10, .deadline_ms = 90, .soft_ms = 40};
    odometry_ = &graph_.add(spec, idle_);
    graph_.add(spec, idle_, scheduler::TaskRole::kLiveOnly);
  }
  void run(StatusPublisher& publisher, int steps, bool alive) {
    for (int i = 0; i < steps; ++i) {
      if (alive) ++odometry_->stats.ticks;
      well_ = publisher.tick(now_ += 50ms);
    }
  }

  support::TemporaryFolder folder_;
  Monitor monitor_;
  scheduler::IdleTask idle_;
  scheduler::TaskGraph graph_;
  scheduler::ScheduledTask* odometry_;
  Time now_{100s};
  bool well_ = true;
};

TEST_F(StatusPublisherTest, TheViewHoldsTheTasksTheModeAndTheEvents) {
  StatusPublisher publisher(graph_, monitor_, {"husky", {}, {}, {}}, now_);
  odometry_->stats.response.record(12ms);
  odometry_->stats.ticks = 5;
  odometry_->stats.misses = 1;
  odometry_->stats.soft_overruns = 2;  // of which one was above the hard budget, too
  odometry_->stats.hard_overruns = 1;
  monitor_.event(now_, "lidar", "late");
  safety::FailsafeDecision decision;
  decision.mode = safety::Mode::kHold;
  decision.cause = safety::Fault::kLidarSilent;
  decision.active = {safety::Fault::kLidarLate, safety::Fault::kLidarSilent};
  decision.epoch = 3;
  publisher.set_decision(decision);
  publisher.set_shed(safety::Shed::kMapDensity);
  publisher.set_scans(834);
  const LiveView v = publisher.view(now_);
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

TEST_F(StatusPublisherTest, OneLinePerSecondAndSignsOfLifeWhileAllIsWell) {
  support::DatagramListener manager((folder_ / "notify").string());
  StatusPublisher publisher(graph_, monitor_, {"husky", folder_ / "live", (folder_ / "notify").string(), 1s}, now_);
  EXPECT_EQ(manager.next(), "READY=1");
  support::StreamClient viewer(folder_ / "live");
  run(publisher, 60, true);
  EXPECT_TRUE(well_);
  const std::string seen = viewer.read();
  EXPECT_EQ(std::count(seen.begin(), seen.end(), '\n'), 3);
  EXPECT_NE(manager.next().find("WATCHDOG=1"), std::string::npos);
  run(publisher, 40, false);
  EXPECT_FALSE(well_);
  EXPECT_EQ(monitor_.events().back().what, "task odometry hangs");
}

TEST_F(StatusPublisherTest, WhatCannotBeOpenedIsAnEvent) {
  StatusPublisher publisher(graph_, monitor_, {"husky", folder_ / "no" / "folder", "relative", {}}, now_);
  EXPECT_EQ(monitor_.events().size(), 2U);
  run(publisher, 20, true);
  EXPECT_TRUE(well_);
}

}  // namespace
}  // namespace cairn::app
