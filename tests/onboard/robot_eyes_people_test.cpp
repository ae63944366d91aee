// SPDX-License-Identifier: Apache-2.0
// Somebody walks past a robot that flies and has eyes instead of a LiDAR.
#include <gtest/gtest.h>

#include "onboard/robot.hpp"
#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn {
namespace {

using people::test::Cylinder;

constexpr float kFlies = 1.2F;  // m, base_link above the ground

RobotConfig with_eyes() {
  RobotConfig c;
  c.stereo.emplace();
  c.stereo->geometry = {
      .width = 672, .height = 376, .fx = 350, .fy = 350, .cx = 335.5, .cy = 187.5, .baseline_m = 0.12};
  c.stereo->T_base_camera =
      SE3::from_xyz_rpy((Vector6() << 0, 0, people::test::kSensorHeight - kFlies, 0, 0, 0).finished());
  c.people.emplace();
  return c;
}

/// Five clouds a second, as a UAV's map gets them. Returns how often somebody was followed.
std::size_t walk_past(Robot& robot) {
  std::size_t followed = 0;
  for (int i = 0; i < 30; ++i) {
    LocatedScan scan;
    scan.stamp = Time{std::chrono::seconds(10)} + i * std::chrono::milliseconds(200);
    const Eigen::Vector2d walker(4, -3 + 0.24 * i);
    scan.points_base = people::test::scan_of({Cylinder{walker, 0.22, 1.75}}, 8);
    for (Eigen::Vector3f& p : scan.points_base) p.z() -= kFlies;
    EXPECT_TRUE(robot.extend_map(scan));
    followed += robot.people().size();
  }
  return followed;
}

TEST(RobotWithEyes, FollowsWhoWalksPastAndLeavesThemOutOfTheMap) {
  Monitor monitor;
  Workers one(1), another(1);
  Robot robot(with_eyes(), one, another, monitor);
  EXPECT_GT(walk_past(robot), 15U);
  std::size_t left = 0;
  for (auto leaf = robot.map().begin_leafs(); leaf != robot.map().end_leafs(); ++leaf)
    if (robot.map().isNodeOccupied(*leaf) && leaf.getZ() > 0.2 - kFlies && leaf.getX() > 3 && leaf.getX() < 6 &&
        std::abs(leaf.getY()) < 4)
      ++left;
  EXPECT_LE(left, 10U) << "voxels where the walker was";
}

}  // namespace
}  // namespace cairn
