// SPDX-License-Identifier: Apache-2.0
// Somebody walks past a robot that flies and has eyes instead of a LiDAR.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "onboard/robot.hpp"
#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn {
namespace {

using people::test::Cylinder;

constexpr double kFlies = 4;  // m above the ground

RobotConfig with_eyes() {
  RobotConfig c;
  c.stereo.emplace();
  c.stereo->geometry = {
      .width = 672, .height = 376, .fx = 350, .fy = 350, .cx = 335.5, .cy = 187.5, .baseline_m = 0.12};
  c.people.emplace();
  return c;
}

/// What eyes that look ahead and down see of the ground, a wall 8 m ahead, and somebody; in base_link.
std::vector<Eigen::Vector3f> cloud_with(const Cylinder& body) {
  const Eigen::Vector3d eye(0, 0, kFlies);
  std::vector<Eigen::Vector3f> points;
  for (double up = -60; up <= 0; ++up)
    for (double around = -45; around <= 45; around += 0.5) {
      const double pitch = up * M_PI / 180, yaw = around * M_PI / 180;
      const Eigen::Vector3d ray(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
      double range = std::min(8 / ray.x(), people::test::meet(body, eye, ray));
      if (ray.z() < 0) range = std::min(range, -eye.z() / ray.z());
      points.push_back((range * ray).cast<float>());
    }
  return points;
}

/// Five clouds a second, as a UAV's map gets them. Returns how often somebody was followed.
std::size_t walk_past(Robot& robot) {
  std::size_t followed = 0;
  for (int i = 0; i < 30; ++i) {
    LocatedScan scan;
    scan.stamp = Time{std::chrono::seconds(10)} + i * std::chrono::milliseconds(200);
    scan.points_base = cloud_with({{3, -3 + 0.24 * i}, 0.22, 1.75});
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
    if (robot.map().isNodeOccupied(*leaf) && leaf.getZ() > 0.2 - kFlies && leaf.getX() > 2 && leaf.getX() < 5) ++left;
  EXPECT_LE(left, 10U) << "voxels where the walker was";
}

}  // namespace
}  // namespace cairn
