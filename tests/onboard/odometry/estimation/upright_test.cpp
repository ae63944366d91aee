// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/upright.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

PatchMap map_of(const std::vector<Eigen::Vector3d>& points) {
  PatchMap map({.finest_block_m = 0.5, .max_blocks = 1 << 12, .max_points_per_block = 400, .criteria = {}});
  Workers workers(1);
  map.insert(points, Room::sensor(), 0, workers);
  return map;
}

std::vector<Keypoint> keypoints(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Keypoint> out;
  for (const Eigen::Vector3d& p : points) out.push_back({p.cast<float>(), 0});
  return out;
}

TEST(UprightColumns, AreThoseOfWallsAndPoles) {
  UprightColumns columns;
  columns.copy(map_of(Room(1).points(20000, 0.01)), {0.2, -0.3, 0});
  const auto has = [&](double x, double y) {
    const Eigen::Vector2f p(static_cast<float>(x - 0.2), static_cast<float>(y + 0.3));
    return columns.count({&p, 1}, 0, 0) == 1;
  };
  EXPECT_TRUE(has(2, 1)) << "the pole";
  EXPECT_TRUE(has(Room::kLow.x(), 0.3));
  EXPECT_TRUE(has(0.7, Room::kLow.y() + Room::kSize.y()));
  EXPECT_FALSE(has(0, 0)) << "floor and ceiling";
  EXPECT_FALSE(has(1000, 0));
  EXPECT_FALSE(has(-1e30, 1e30)) << "no int holds that";
}

TEST(UprightColumns, AShiftMovesThePoints) {
  UprightColumns columns;
  columns.copy(map_of(Room(1).points(20000, 0.01)), {0, 0, 0});
  const Eigen::Vector2f middle(0, 0);
  EXPECT_EQ(columns.count({&middle, 1}, 2, 1), 1);
  EXPECT_EQ(columns.count({&middle, 1}, 0, 0), 0);
}

TEST(UprightPoints, AreNeitherFloorNorCeilingHoweverTheSensorIsTilted) {
  const std::vector<Eigen::Vector3d> points = Room(1).points(3000, 0.01);
  for (const double pitch : {0.0, 0.1, -0.1}) {
    const SE3 T_odom_lidar = SE3::from_xyz_rpy((Vector6() << 0, 0, 0, 0, pitch, 0).finished());
    std::vector<Eigen::Vector3d> seen;
    for (const Eigen::Vector3d& p : points) seen.push_back(T_odom_lidar.inverse() * p);
    const std::vector<Keypoint> all = keypoints(seen);
    std::vector<Keypoint> chosen;
    UprightPoints().choose(all, T_odom_lidar, 1000, chosen);
    const auto inside = std::ranges::count_if(chosen, [&](const Keypoint& k) {
      const Eigen::Vector3d p = T_odom_lidar * k.p_lidar.cast<double>();
      const Eigen::Array2d from_low = (p - Room::kLow).head<2>(), to_high = Room::kSize.head<2>().array() - from_low;
      return from_low.min(to_high).minCoeff() > 0.8 && (p.head<2>() - Eigen::Vector2d(2, 1)).norm() > 0.8;
    });
    EXPECT_GT(chosen.size(), 500u);
    EXPECT_LE(chosen.size(), 1000u);
    EXPECT_EQ(inside, 0) << "floor or ceiling, with a room of 3 m between them";
  }
}

}  // namespace
}  // namespace cairn::odometry
