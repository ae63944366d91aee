// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/keypoint_selector.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <set>

namespace cairn::odometry {
namespace {

/// Points on the floor of a square room of this edge, all in range, each with an age of its own.
PreparedScan floor_of(double edge_m, std::size_t points) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> at(0, static_cast<float>(edge_m));
  PreparedScan scan;
  scan.duration_s = 0.1;
  for (std::size_t i = 0; i < points; ++i) {
    scan.points_lidar.push_back({at(random), at(random), 0.01F});
    scan.age_s.push_back(0.1F * static_cast<float>(i) / static_cast<float>(points));
    scan.in_range.push_back(static_cast<std::uint32_t>(i));
  }
  return scan;
}

std::array<int, 3> cube(const Eigen::Vector3f& p, float edge) {
  const Eigen::Vector3f at = (p / edge).array().floor();
  return {static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())};
}

TEST(KeypointSelector, TheMapGetsOnePointOfEveryCube) {
  const PreparedScan scan = floor_of(3, 5000);
  OdometryConfig config;
  config.insert_spacing_m = 0.25;
  KeypointSelector selector(config);
  const Selection selection = selector.select(scan);
  std::set<std::array<int, 3>> all, chosen;
  for (const std::uint32_t i : scan.in_range) all.insert(cube(scan.points_lidar[i], 0.25F));
  for (const std::uint32_t i : selection.for_map)
    EXPECT_TRUE(chosen.insert(cube(scan.points_lidar[i], 0.25F)).second) << "a second point of one cube";
  EXPECT_EQ(chosen, all);
  EXPECT_EQ(selection.duration_s, scan.duration_s);
}

TEST(KeypointSelector, KeypointsAreSomeOfTheMapsPointsWithTheirAges) {
  const PreparedScan scan = floor_of(20, 20000);
  KeypointSelector selector({});
  const Selection selection = selector.select(scan);
  ASSERT_GT(selection.keypoints.size(), 1000U);
  ASSERT_LT(selection.keypoints.size(), selection.for_map.size());
  std::map<float, Eigen::Vector3f> of_map;  // by their ages, which differ
  for (const std::uint32_t i : selection.for_map) of_map[scan.age_s[i]] = scan.points_lidar[i];
  for (const Keypoint& k : selection.keypoints) {
    ASSERT_TRUE(of_map.contains(k.age_s));
    EXPECT_EQ(of_map[k.age_s], k.p_lidar);
  }
}

TEST(KeypointSelector, TheSpacingFollowsUntilTheNumberIsAsWanted) {
  OdometryConfig config;
  config.keypoints = 800;
  KeypointSelector selector(config);
  for (const double edge_m : {60.0, 12.0, 30.0}) {
    const PreparedScan scan = floor_of(edge_m, 60000);
    std::size_t n = 0;
    for (int i = 0; i < 60; ++i) {
      n = selector.select(scan).keypoints.size();
      EXPECT_LE(n, 1600U) << "twice as many at most";
    }
    EXPECT_NEAR(static_cast<double>(n), 800, 0.12 * 800) << edge_m;
  }
}

TEST(KeypointSelector, TheSpacingStaysWithinItsBounds) {
  OdometryConfig config;
  config.keypoints = 800;
  KeypointSelector selector(config);
  const PreparedScan small = floor_of(1, 50), large = floor_of(1000, 50000);
  for (int i = 0; i < 200; ++i) (void)selector.select(small);
  EXPECT_EQ(selector.spacing_m(), 0.05F) << "not below the map's";
  for (int i = 0; i < 200; ++i) (void)selector.select(large);
  EXPECT_EQ(selector.spacing_m(), 3.0F);
}

TEST(KeypointSelector, AScanWithoutPointsGivesNone) {
  KeypointSelector selector({});
  const Selection selection = selector.select({});
  EXPECT_TRUE(selection.for_map.empty());
  EXPECT_TRUE(selection.keypoints.empty());
}

}  // namespace
}  // namespace cairn::odometry
