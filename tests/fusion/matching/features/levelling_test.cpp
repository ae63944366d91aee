// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/levelling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fusion/matching/features/map_features.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;

SE3 turn_of(double roll, double pitch, double yaw) {
  Vector6 v;
  v << 0.037, -0.021, 0.03, roll, pitch, yaw;
  return SE3::from_xyz_rpy(v);
}

/// Surfels every 0.4 m of a rectangle that two edges span from a corner.
void add_surface(std::vector<Surfel>& surfels, const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
                 const Eigen::Vector3f& v) {
  constexpr float kEvery_m = 0.4F;
  for (float i = 0; i < u.norm(); i += kEvery_m)
    for (float j = 0; j < v.norm(); j += kEvery_m) {
      Surfel s;
      s.point = corner + i * u.normalized() + j * v.normalized();
      s.normal = u.cross(v).normalized();
      surfels.push_back(s);
    }
}

/// Houses on ground that rises by four degrees along x.
std::vector<Surfel> hillside() {
  const auto rise = static_cast<float>(std::tan(4 * kDegree_rad));
  std::vector<Surfel> surfels;
  add_surface(surfels, {-20, -20, -20 * rise}, {40, 0, 40 * rise}, {0, 40, 0});
  for (const float x : {-12.0F, 2.0F})
    for (const float y : {-10.0F, 5.0F}) {
      add_surface(surfels, {x, y, x * rise}, {8, 0, 0}, {0, 0, 4});
      add_surface(surfels, {x, y, x * rise}, {0, 6, 0}, {0, 0, 4});
    }
  return surfels;
}

double lean_rad(const SE3& T_level_world) { return std::acos(std::min(1.0, T_level_world.rotation()(2, 2))); }

TEST(Straightening, IsHeldByWallsWhereTheGroundSlopes) {
  for (const double lean_deg : {0.0, 3.0, 8.0}) {
    const SE3 T_map_world = turn_of(lean_deg * kDegree_rad, -0.4 * lean_deg * kDegree_rad, 0.8);
    const SE3 T_level_map = straightening(turned(hillside(), T_map_world));
    EXPECT_LT(lean_rad(T_level_map * T_map_world), 1 * kDegree_rad) << lean_deg;
  }
}

TEST(Straightening, IsHeldByTheFloorAlongACorridor) {
  std::vector<Surfel> surfels;
  add_surface(surfels, {0, 0, 0}, {40, 0, 0}, {0, 4, 0});
  for (const float y : {0.0F, 4.0F}) add_surface(surfels, {0, y, 0}, {40, 0, 0}, {0, 0, 2.5F});
  const SE3 T_map_world = turn_of(0.02, 0.09, 1.2);
  EXPECT_LT(lean_rad(straightening(turned(surfels, T_map_world)) * T_map_world), 1 * kDegree_rad);
}

TEST(Straightening, LeavesAMapAsItIsWhereLittleIsFlat) {
  EXPECT_EQ(straightening({}).matrix(), Eigen::Matrix4d::Identity());
  std::vector<Surfel> wall;
  add_surface(wall, {0, 0, 0}, {1.5F, 0, 0.15F}, {0, 1.5F, 0});
  EXPECT_EQ(straightening(wall).matrix(), Eigen::Matrix4d::Identity());
}

TEST(Levelling, TurnsTheFloorUpwards) {
  const support::Scene scene = support::office();
  const SE3 turn = turn_of(0.3, -0.5, 0.4);
  const SE3 T_map_world = turn * support::pose_on(scene.ride, 0).inverse();
  const auto map = support::stretch_map(scene, {0, 2.2, 10}, T_map_world, 5, 0.1, 10);
  const auto turns = levellings(MapFeatures::build(*map)->fine());
  ASSERT_FALSE(turns.empty());
  EXPECT_LE(turns.size(), 3U);
  const Eigen::Vector3d up = turns.front() * (T_map_world.rotation() * Eigen::Vector3d::UnitZ());
  EXPECT_GT(up.z(), std::cos(0.02));
}

TEST(Levelling, OfNothingIsNone) {
  const auto turns = levellings({});
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_EQ(turns.front().matrix(), Eigen::Matrix4d::Identity());
}

}  // namespace
}  // namespace cairn::matching
