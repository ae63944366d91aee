// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/voxel_positions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace cairn::merging {
namespace {

constexpr double kVoxel_m = 0.2;

/// A row of occupied voxels along x.
mapping::SemanticOcTree row(int from, int to, float log_odds) {
  mapping::SemanticOcTree map(kVoxel_m);
  for (int i = from; i < to; ++i)
    map.setNodeValue(octomap::point3d(0.2F * static_cast<float>(i) + 0.1F, 0.1F, 0.1F), log_odds);
  return map;
}

UncertainPose turned_about_z(double sigma_rad) {
  UncertainPose pose;
  pose.covariance(5, 5) = sigma_rad * sigma_rad;
  return pose;
}

TEST(VoxelPositions, OneMapGivesEachVoxelItsOwnUncertainty) {
  const auto map = row(0, 10, 3.5F);
  const std::array maps{PlacedMap{&map, {}}};
  const auto positions = voxel_positions(map, maps);
  ASSERT_TRUE(positions);
  ASSERT_EQ(positions->size(), 10U);
  for (const VoxelPosition& voxel : *positions) {
    EXPECT_EQ(voxel.maps, 1);
    EXPECT_NEAR(rms_m(voxel.position), std::sqrt(3 / 0.9707) * kVoxel_m / 2, 1e-4);
    EXPECT_EQ(voxel.alone_m, rms_m(voxel.position));
  }
}

TEST(VoxelPositions, WhatTwoMapsKnowIsKnownBetterThanByEither) {
  const auto a = row(0, 10, 2), b = row(5, 15, 2), fused = row(0, 15, 2);
  const std::array maps{PlacedMap{&a, {}}, PlacedMap{&b, turned_about_z(0.01)}};
  const auto positions = voxel_positions(fused, maps);
  ASSERT_TRUE(positions);
  ASSERT_EQ(positions->size(), 15U);
  int shared = 0;
  for (const VoxelPosition& voxel : *positions) {
    shared += voxel.maps == 2;
    EXPECT_EQ(rms_m(voxel.position) < voxel.alone_m, voxel.maps == 2);
  }
  EXPECT_EQ(shared, 5);
  const mapping::PositionFigures figures = position_figures(*positions);
  EXPECT_EQ(figures.voxels, 15U);
  EXPECT_EQ(figures.shared, 5U);
  EXPECT_LT(figures.shared_mean_m, 0.75 * figures.shared_alone_m);
  EXPECT_GE(figures.p95_m, figures.mean_m);
}

TEST(VoxelPositions, APoseThatMayBeTurnedMovesFarVoxelsMore) {
  const auto map = row(0, 500, 3.5F);
  const std::array maps{PlacedMap{&map, turned_about_z(0.01)}};
  const auto positions = voxel_positions(map, maps);
  ASSERT_TRUE(positions);
  for (const VoxelPosition& voxel : *positions) {
    const double far_m = voxel.position.mean.head<2>().norm();
    const double own = kVoxel_m * kVoxel_m / 4 / 0.9707;
    EXPECT_NEAR(voxel.position.covariance.trace(), 3 * own + std::pow(0.01 * far_m, 2), 1e-4);
  }
}

TEST(VoxelPositions, AVoxelThatNoMapKnowsIsAlone) {
  const auto fused = row(0, 1, 2);
  const auto positions = voxel_positions(fused, {});
  ASSERT_TRUE(positions);
  ASSERT_EQ(positions->size(), 1U);
  EXPECT_EQ(positions->front().maps, 0);
  EXPECT_GT(rms_m(positions->front().position), 0);
  EXPECT_EQ(position_figures({}).voxels, 0U);
}

TEST(VoxelPositions, ACraftedMapIsRefused) {
  mapping::SemanticOcTree all(kVoxel_m);
  bool made = false;
  all.root_or_new(made)->setLogOdds(2);
  all.settle_count();
  EXPECT_FALSE(voxel_positions(all, {}));
}

}  // namespace
}  // namespace cairn::merging
