// SPDX-License-Identifier: Apache-2.0
// A robot that stands while a teammate drives past.
#include <gtest/gtest.h>

#include "onboard/robot.hpp"
#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn {
namespace {

using people::test::Cylinder;

constexpr double kSpeed = 0.8;  // m/s, of the mate

class RobotMates : public ::testing::Test {
 protected:
  static RobotConfig config() {
    RobotConfig c;
    c.T_base_lidar = SE3::from_xyz_rpy((Vector6() << 0, 0, people::test::kSensorHeight, 0, 0, 0).finished());
    c.people.emplace();
    return c;
  }
  [[nodiscard]] static Eigen::Vector3d mate_at(double t) { return {4, -1.5 + kSpeed * t, 0}; }

  /// Three seconds of scans; `told`: where the mate is, some time ago. Returns how often somebody was followed.
  std::size_t drive_past(Duration told_ago, std::uint32_t epoch = 0, double radius = 0.5) {
    std::size_t followed = 0;
    for (int i = 0; i < 30; ++i) {
      const double t = 0.1 * i, told_at = t - to_seconds(told_ago);
      const Mate mate{.stamp = start_ + from_seconds(told_at),
                      .position = mate_at(told_at),
                      .velocity = {0, kSpeed},
                      .radius_m = radius,
                      .height_m = 0.9};
      robot_.note_mates(std::span(&mate, 1), epoch);
      LocatedScan scan;
      scan.stamp = start_ + from_seconds(t);
      scan.points_base = people::test::scan_of({Cylinder{mate_at(t).head<2>(), 0.4, 0.9}}, 8);
      EXPECT_TRUE(robot_.extend_map(scan));
      followed += robot_.people().size();
    }
    return followed;
  }
  /// Occupied voxels above the ground between 3 m and 6 m ahead, and of the wall.
  [[nodiscard]] std::pair<std::size_t, std::size_t> voxels() const {
    std::pair<std::size_t, std::size_t> count;
    for (auto leaf = robot_.map().begin_leafs(); leaf != robot_.map().end_leafs(); ++leaf) {
      if (!robot_.map().isNodeOccupied(*leaf) || leaf.getZ() < 0.15) continue;
      count.first += leaf.getX() > 3 && leaf.getX() < 6 && std::abs(leaf.getY()) < 3 ? 1 : 0;
      count.second += std::abs(leaf.getX() - 8) < 0.2 ? 1 : 0;
    }
    return count;
  }
  Time start_{std::chrono::seconds(10)};
  Monitor monitor_;
  Workers one_{1}, another_{1};
  Robot robot_{config(), one_, another_, monitor_};
};

TEST_F(RobotMates, StayOutOfTheMapAndAreNoPeople) {
  EXPECT_EQ(drive_past(std::chrono::milliseconds(300)), 0U);
  EXPECT_EQ(voxels().first, 0U);
  EXPECT_GT(voxels().second, 100U);
}

TEST_F(RobotMates, WhoseNewsIsOldAreAsAnythingElse) {
  drive_past(Robot::kMateLife + std::chrono::milliseconds(1));
  EXPECT_GT(voxels().first, 5U);
}

TEST_F(RobotMates, OfAnotherMapMeanNothing) {
  drive_past({}, 3);
  EXPECT_GT(voxels().first, 5U);
}

TEST_F(RobotMates, ThatDoNotTellTheirSizeMeanNothing) {
  drive_past({}, 0, 0);
  EXPECT_GT(voxels().first, 5U);
}

}  // namespace
}  // namespace cairn
