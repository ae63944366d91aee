// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/map_overlap.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/onboard/report/random_map.hpp"

namespace cairn::team_run {
namespace {

/// A wall of 20 by 10 voxels at x, and known free space in front of it.
mapping::SemanticOcTree wall(int x) {
  mapping::SemanticOcTree map(0.1);
  const auto at = [](int i) { return 0.05F + 0.1F * static_cast<float>(i); };
  for (int y = 0; y < 20; ++y)
    for (int z = 0; z < 10; ++z) {
      for (int free = 0; free < x; ++free) map.updateNode(octomap::point3d(at(free), at(y), at(z)), false);
      map.updateNode(octomap::point3d(at(x), at(y), at(z)), true);
    }
  return map;
}

SE3 moved_x(double metres) { return {Eigen::Quaterniond::Identity(), {metres, 0, 0}}; }

SE3 random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> draw(-2, 2);
  Vector6 xi;
  for (int i = 0; i < 6; ++i) xi[i] = draw(random);
  return SE3::exp(xi);
}

TEST(IouWithWorld, OfTheWorldItselfIsOneAndOfNothingIsNone) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const auto world = report::random_map(seed);
    EXPECT_EQ(iou_with_world(*world, SE3(), *world), 1.0);
  }
  EXPECT_FALSE(iou_with_world(mapping::SemanticOcTree(0.1), SE3(), mapping::SemanticOcTree(0.1)));
}

TEST(IouWithWorld, AllowsForOneVoxelAndNoMore) {
  const mapping::SemanticOcTree world = wall(10), near = wall(11), far = wall(13);
  EXPECT_EQ(iou_with_world(near, SE3(), world), 1.0);
  EXPECT_EQ(iou_with_world(far, SE3(), world), 0.0);
  EXPECT_EQ(iou_with_world(far, moved_x(-0.3), world), 1.0);
}

TEST(IouWithWorld, WithinAnAreaTheRestDoesNotCount) {
  mapping::SemanticOcTree map = wall(10), area = wall(10);
  map.updateNode(octomap::point3d(5.05F, 5.05F, 5.05F), true);  // nothing of the kind is in the world
  const Area within{area, SE3()};
  EXPECT_LT(iou_with_world(map, SE3(), wall(10)).value(), 1.0);
  EXPECT_EQ(iou_with_world(map, SE3(), wall(10), &within), 1.0);
  const Area elsewhere{area, moved_x(-20)};
  EXPECT_FALSE(iou_with_world(map, SE3(), wall(10), &elsewhere));
}

TEST(IouWithWorld, WhatTheMapDoesNotKnowIsNotHeldAgainstIt) {
  const mapping::SemanticOcTree map = wall(10);
  mapping::SemanticOcTree world = wall(10);
  world.updateNode(octomap::point3d(3.05F, 0.05F, 0.05F), true);
  EXPECT_EQ(iou_with_world(map, SE3(), world), 1.0);
  world.updateNode(octomap::point3d(0.25F, 0.05F, 0.05F), true);  // free in the map
  EXPECT_DOUBLE_EQ(iou_with_world(map, SE3(), world).value(), 200.0 / 201);
}

TEST(OccupiedLeaves, CountsThem) { EXPECT_EQ(occupied_leaves(wall(5)), 200U); }

/// An estimate that is off by exp(ξ) at the other robot's base has that error, wherever both robots are.
TEST(SightError, IsWhatTheEstimateIsOffBy) {
  std::mt19937 random(4);
  for (int i = 0; i < 50; ++i) {
    const Standing a{random_pose(random), random_pose(random)}, b{random_pose(random), random_pose(random)};
    const SE3 truth = a.T_world_odom().inverse() * b.T_world_odom();
    EXPECT_LT(sight_error(a, b, truth).log().norm(), 1e-9);
    const SE3 off = SE3::exp(0.1 * random_pose(random).log());
    const SE3 estimate = truth * b.T_odom_base * off * b.T_odom_base.inverse();
    EXPECT_LT((sight_error(a, b, estimate).inverse() * off).log().norm(), 1e-9);
  }
}

TEST(IsWrongMerge, ByPlaceOrByHeading) {
  EXPECT_FALSE(is_wrong_merge(moved_x(0.9)));
  EXPECT_TRUE(is_wrong_merge(moved_x(1.1)));
  EXPECT_TRUE(is_wrong_merge(SE3::exp((Vector6() << 0, 0, 0, 0, 0, 0.3).finished())));
}

}  // namespace
}  // namespace cairn::team_run
