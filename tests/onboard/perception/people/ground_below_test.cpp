// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/ground_below.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace cairn::people {
namespace {

using Eigen::Vector3f;

/// Of a floor at z = −1.5 m, with a tilt, seen with noise.
std::vector<Vector3f> floor_points(int count, float tilt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> ahead(1, 6), aside(-3, 3);
  std::normal_distribution<float> noise(0, 0.04F);
  std::vector<Vector3f> points;
  for (int i = 0; i < count; ++i) {
    const float x = ahead(random);
    points.emplace_back(x, aside(random), -1.5F + tilt * x + noise(random));
  }
  return points;
}

TEST(HeightAboveGround, IsThatOfTheFloorInView) {
  const auto height = height_above_ground(floor_points(2000, 0), Vector3f(0, 0, 0.3F));
  ASSERT_TRUE(height);
  EXPECT_NEAR(*height, 1.8F, 0.06F);
}

TEST(HeightAboveGround, WrongPointsBelowAndWallsAboveAreNotTheGround) {
  auto points = floor_points(2000, 0.02F);
  for (int i = 0; i < 60; ++i) points.emplace_back(4, 0, -3.0F - 0.02F * static_cast<float>(i));
  for (int i = 0; i < 4000; ++i) points.emplace_back(5, 1, -1.0F + 0.0005F * static_cast<float>(i));
  const auto height = height_above_ground(points, Vector3f::Zero());
  ASSERT_TRUE(height);
  EXPECT_NEAR(*height, 1.45F, 0.15F);
}

TEST(HeightAboveGround, IsUnknownWhereTooLittleIsSeen) {
  EXPECT_FALSE(height_above_ground({}, Vector3f::Zero()));
  EXPECT_FALSE(height_above_ground(floor_points(30, 0), Vector3f::Zero()));
  EXPECT_FALSE(height_above_ground(floor_points(2000, 0), Vector3f(0, 0, -3))) << "all of it is above the sensor";
  const std::vector<Vector3f> far(2000, Vector3f(20, 0, -1));
  EXPECT_FALSE(height_above_ground(far, Vector3f::Zero()));
}

TEST(HeightAboveGround, WhatIsNotFiniteIsNotSeen) {
  auto points = floor_points(2000, 0);
  points.emplace_back(NAN, 0, -9);
  points.emplace_back(0, 0, NAN);
  points.emplace_back(1, 0, -INFINITY);
  const auto height = height_above_ground(points, Vector3f::Zero());
  ASSERT_TRUE(height);
  EXPECT_NEAR(*height, 1.5F, 0.06F);
}

}  // namespace
}  // namespace cairn::people
