// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "fusion/matching/matcher.hpp"
#include "tests/fusion/team/fleet/network.hpp"
#include "tests/fusion/team/fleet/riding_robot.hpp"

namespace cairn::fleet {

struct Start {
  double from, yaw;
  Drift drift = {};
};

/// Robots, their network and their common time.
class Ride {
 public:
  Ride(const support::Scene& scene, const std::vector<Start>& starts, const LinkQuality& quality,
       team::TeamConfig config)
      : network_(quality, 1) {
    for (const Start& start : starts) {
      config.id = robots_.size() + 1;
      config.name = "robot_" + std::to_string(config.id);
      config.exchange.bytes_per_second = 32000;
      robots_.push_back(std::make_unique<RidingRobot>(config, scene, start.from, start.yaw, start.drift));
    }
  }

  /// A scan every two seconds of the first so many.
  void run(int scans, double dphi, Duration length) {
    using namespace std::chrono_literals;
    for (const Time end = now_ + length; now_ < end; now_ += 200ms) {
      if (scans > 0 && now_.time_since_epoch() % 2s == Duration::zero()) {
        for (auto& robot : robots_) robot->ride(dphi, now_);
        --scans;
      }
      for (const auto& arrived : network_.arrived(now_))
        EXPECT_TRUE(at(arrived.to).team.receive(arrived.bytes, now_).has_value());
      for (auto& robot : robots_) step(*robot);
    }
  }

  [[nodiscard]] RidingRobot& at(RobotId id) { return *robots_[id - 1]; }
  [[nodiscard]] std::size_t size() const { return robots_.size(); }
  [[nodiscard]] Time now() const { return now_; }

 private:
  void step(RidingRobot& robot) {
    std::vector<peers::Outgoing> out;
    robot.team.step(now_, out);
    const RobotId self = robot.team.exchange().self();
    for (const auto& datagram : out) network_.send(self, robots_.size(), datagram, now_);
    if (auto job = robot.team.next_match(now_)) {
      Budget budget = Budget::steps(matching::kAmpleSteps);
      cairn::team::run(*job, budget);
      robot.team.matched(std::move(*job), now_);
    }
    Budget slice = Budget::steps(200);
    (void)robot.team.fuse(slice);
  }

  Network network_;
  std::vector<std::unique_ptr<RidingRobot>> robots_;
  Time now_{};
};

}  // namespace cairn::fleet
