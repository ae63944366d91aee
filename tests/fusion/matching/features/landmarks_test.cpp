// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/landmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/fusion/matching/plan_surfels.hpp"

namespace cairn::matching {
namespace {

constexpr std::size_t kMany = 100;

TEST(Landmarks, AreWhereWallsMeet) {
  std::vector<Surfel> surfels;
  const Eigen::Vector2f corner(3.13F, -2.41F);
  add_wall(surfels, corner, corner + Eigen::Vector2f(5, 0));
  add_wall(surfels, corner, corner + Eigen::Vector2f(0, 5));
  const auto found = landmarks(surfels, kMany);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found.front().at - corner).norm(), 0.02F);
  EXPECT_NEAR(found.front().cross.x(), 1, 0.01);  // walls along x and y
  EXPECT_NEAR(found.front().cross.y(), 0, 0.01);
}

TEST(Landmarks, AStraightWallAndAFloorHaveNone) {
  std::vector<Surfel> surfels;
  add_wall(surfels, {0, 0}, {12, 5});
  for (int i = 0; i < 400; ++i) {
    Surfel floor;
    floor.point = Eigen::Vector3f(0.3F * static_cast<float>(i % 20), 0.3F * static_cast<float>(i / 20), 0);
    floor.normal = Eigen::Vector3f::UnitZ();
    surfels.push_back(floor);
  }
  EXPECT_TRUE(landmarks(surfels, kMany).empty());
  EXPECT_TRUE(landmarks({}, kMany).empty());
}

TEST(Landmarks, AThinPillarIsOneAndTheStrongestComeFirst) {
  std::vector<Surfel> surfels;
  add_pillar(surfels, {-4, 1}, 0.3F, 4);
  add_pillar(surfels, {7, 2}, 0.3F, 2);
  const auto found = landmarks(surfels, kMany);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT((found[0].at - Eigen::Vector2f(-4, 1)).norm(), 0.1F);
  EXPECT_LT((found[1].at - Eigen::Vector2f(7, 2)).norm(), 0.1F);
  EXPECT_GT(found[0].strength, found[1].strength);
  EXPECT_EQ(landmarks(surfels, 1).size(), 1U);
}

TEST(Landmarks, ATrunkHasOneMiddleFromAllSides) {
  constexpr float kRadius_m = 0.35F;
  const Eigen::Vector2f trunk(2.1F, -8.4F);
  for (const float from_rad : {0.0F, 1.6F, 3.9F}) {
    std::vector<Surfel> seen;  // half of it
    for (float angle = from_rad; angle < from_rad + 3.1F; angle += 0.3F)
      for (float z = 0; z < 2; z += 0.2F) {
        Surfel s;
        s.normal << std::cos(angle), std::sin(angle), 0;
        s.point << trunk + kRadius_m * s.normal.head<2>(), z;
        s.oriented = true;
        seen.push_back(s);
      }
    const auto found = landmarks(seen, kMany);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_LT((found.front().at - trunk).norm(), 0.02F);
    EXPECT_LT(found.front().cross.norm(), 0.3F);
  }
}

TEST(Landmarks, TurnAndMoveWithTheMap) {
  std::vector<Surfel> surfels, turned;
  add_wall(surfels, {0, 0}, {6, 0});
  add_wall(surfels, {0, 0}, {0, 6});
  add_pillar(surfels, {9, 4}, 0.3F, 3);
  const Eigen::Matrix3f R = Eigen::AngleAxisf(1.1F, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const Eigen::Vector3f t(40.2F, -7.7F, 3);
  for (Surfel s : surfels) {
    s.point = R * s.point + t;
    s.normal = R * s.normal;
    turned.push_back(s);
  }
  const auto before = landmarks(surfels, kMany), after = landmarks(turned, kMany);
  ASSERT_EQ(before.size(), 2U);
  ASSERT_EQ(after.size(), 2U);
  for (const Landmark& l : before) {
    const Eigen::Vector2f there = R.topLeftCorner<2, 2>() * l.at + t.head<2>();
    EXPECT_TRUE(
        std::any_of(after.begin(), after.end(), [&](const Landmark& k) { return (k.at - there).norm() < 0.1F; }));
  }
}

}  // namespace
}  // namespace cairn::matching
