// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/pairs/map_pair.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tools/protocol/pairs/halves.hpp"

namespace cairn::protocol {
namespace {

/// A floor of 8 × 2 m and 0.1 m voxels with free space above.
std::shared_ptr<mapping::SemanticOcTree> floor_map() {
  auto map = std::make_shared<mapping::SemanticOcTree>(0.1);
  const auto middle = [](int cell) { return 0.1F * static_cast<float>(cell) + 0.05F; };
  for (int x = 0; x < 80; ++x)
    for (int y = 0; y < 20; ++y) {
      map->setNodeValue(octomap::point3d(middle(x), middle(y), middle(0)), 2.0F, true);
      map->setNodeValue(octomap::point3d(middle(x), middle(y), middle(1)), -1.0F, true);
    }
  map->canonicalise();
  return map;
}

SE3 shifted(double x) { return {Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 0, 0)}; }

MapPair same_floor_twice() {
  MapPair pair;
  pair.name = pair.scene = "floor";
  pair.a = pair.b = floor_map();
  measure(pair);
  return pair;
}

TEST(MapPair, AMapOverlapsItselfWholly) {
  const MapPair pair = same_floor_twice();
  EXPECT_DOUBLE_EQ(pair.overlap, 1);
  EXPECT_EQ(pair.voxels_a, 1600U);
  const SE3 away = shifted(100);
  EXPECT_DOUBLE_EQ(overlap_of(*pair.a, *pair.b, away), 0);
  const SE3 half = shifted(4);
  EXPECT_NEAR(overlap_of(*pair.a, *pair.b, half), 0.5, 0.03);
}

TEST(MapPair, IsCutToTheOverlapThatWasAskedFor) {
  const MapPair whole = same_floor_twice();
  for (const double overlap : {0.45, 0.3, 0.1}) {
    const MapPair cut = cut_to_overlap(whole, Eigen::Vector3d::UnitX(), overlap);
    EXPECT_NEAR(cut.overlap, overlap, 0.04);
    EXPECT_EQ(cut.voxels_a, occupied_centres(*cut.a).size());
    for (const auto& p : occupied_centres(*cut.a)) EXPECT_LT(p.x(), 6.5F);
    for (const auto& p : occupied_centres(*cut.b)) EXPECT_GT(p.x(), 1.5F);
    const auto* free = cut.a->search(0.05, 0.05, 0.15);
    ASSERT_NE(free, nullptr);
    EXPECT_FLOAT_EQ(free->getLogOdds(), -1);
  }
}

TEST(MapPair, WhatOverlapsLessStaysWhole) {
  MapPair whole = same_floor_twice();
  whole.T_a_b = shifted(6);
  measure(whole);
  const MapPair cut = cut_to_overlap(whole, Eigen::Vector3d::UnitX(), 0.5);
  EXPECT_EQ(cut.voxels_a, whole.voxels_a);
  EXPECT_EQ(cut.voxels_b, whole.voxels_b);
}

TEST(MapPair, ComesBackFromItsFolder) {
  const support::TemporaryFolder folder;
  MapPair pair = same_floor_twice();
  pair.kind = kOverlap;
  pair.T_a_b = SE3::from_xyz_rpy((Vector6() << 1.25, -2, 0.3, 0.1, 0.2, -3).finished());
  ASSERT_TRUE(save_pair(pair, folder.path() / "floor"));
  const auto back = load_pair(folder.path() / "floor");
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->name, "floor");
  EXPECT_EQ(back->kind, kOverlap);
  EXPECT_EQ(back->voxels_a, pair.voxels_a);
  EXPECT_EQ(back->overlap, pair.overlap);
  EXPECT_LT((back->T_a_b.matrix() - pair.T_a_b.matrix()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(back->a->size(), pair.a->size());
  EXPECT_FALSE(load_pair(folder.path()));
}

TEST(Halves, ShareWhatTheyAreAskedToAndLieWhereTheySay) {
  HalvesOptions options;
  options.yaw = 0.8;
  options.dropped = 0;
  MapPair pair = halves(*floor_map(), "floor", options);
  measure(pair);
  EXPECT_NEAR(pair.overlap, 0.4, 0.06);
  EXPECT_GT(overlap_of(*pair.a, *pair.b, pair.T_a_b), overlap_of(*pair.a, *pair.b, pair.T_a_b.inverse()));
}

}  // namespace
}  // namespace cairn::protocol
