// SPDX-License-Identifier: Apache-2.0
// Robots that ride through one scene, over a bad link: they find each other without a guess and end with one map.
#include "fusion/team.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <sstream>

#include "tests/fusion/fleet/network.hpp"
#include "tests/fusion/fleet/riding_robot.hpp"

namespace cairn {
namespace {

using fleet::Network;
using fleet::RidingRobot;
using peers::RobotId;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kAll = 1U << 20U;

struct Start {
  double from, yaw;
};

/// Robots, their network and their common time.
class Ride {
 public:
  Ride(const support::Scene& scene, const std::vector<Start>& starts, const fleet::LinkQuality& quality)
      : network_(quality, 1) {
    for (const Start& start : starts) {
      TeamConfig config;
      config.id = robots_.size() + 1;
      config.name = "robot_" + std::to_string(config.id);
      config.resolution_m = 0.1;
      config.exchange.bytes_per_second = 32000;
      robots_.push_back(std::make_unique<RidingRobot>(config, scene, start.from, start.yaw));
    }
  }

  /// A scan every two seconds of the first so many.
  void run(int scans, double dphi, Duration length) {
    for (const Time end = now_ + length; now_ < end; now_ += milliseconds(200)) {
      if (scans > 0 && now_.time_since_epoch() % seconds(2) == Duration::zero()) {
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
      cairn::run(*job, budget);
      robot.team.matched(std::move(*job), now_);
    }
    Budget slice = Budget::steps(200);
    (void)robot.team.fuse(slice);
  }

  Network network_;
  std::vector<std::unique_ptr<RidingRobot>> robots_;
  Time now_{};
};

std::string bytes_of(const SemanticOcTree& map) {
  std::ostringstream out;
  (void)const_cast<SemanticOcTree&>(map).writeData(out);
  return out.str();
}

TEST(Team, FindsItsMembersAndAllHaveOneMap) {
  Ride ride(support::lobby(), {{0, 0.7}, {0.9, 2.0}, {-0.9, -1.1}},
            {0.2, 0.05, 0, milliseconds(20), milliseconds(300)});
  ride.run(34, 0.09, seconds(110));
  for (RobotId id = 1; id <= ride.size(); ++id) {
    const Team& team = ride.at(id).team;
    EXPECT_EQ(team.poses().anchor, 1U);
    ASSERT_EQ(team.poses().T_team_odom.size(), 3U)
        << team.standing(2, ride.now()).reason << "; " << team.standing(3, ride.now()).reason;
    EXPECT_TRUE(team.map().up_to_date());
    for (const auto& [peer, T_team_odom] : team.poses().T_team_odom) {
      const SE3 truth = ride.at(1).T_odom_world() * ride.at(peer).T_odom_world().inverse();
      const SE3 error = truth.inverse() * T_team_odom;
      EXPECT_LT(error.translation().norm(), 0.1) << id << " about " << peer;
      EXPECT_LT(rotation_angle(error), 0.01) << id << " about " << peer;
    }
    EXPECT_EQ(bytes_of(team.map().map()), bytes_of(ride.at(1).team.map().map()));
    EXPECT_GT(known_tiles(team.map().map(), kAll).size(), known_tiles(ride.at(id).map(), kAll).size());
  }
}

}  // namespace
}  // namespace cairn
