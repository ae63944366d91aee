// SPDX-License-Identifier: Apache-2.0
#include "onboard/earlier_maps.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cairn {
namespace {

std::unique_ptr<mapping::SemanticOcTree> map_of(int voxels) {
  auto tree = std::make_unique<mapping::SemanticOcTree>(0.1);
  for (int i = 0; i < voxels; ++i) tree->updateNode(octomap::point3d(static_cast<float>(i), 0, 0), true);
  return tree;
}
UncertainPose ahead(double x) { return {SE3::from_xyz_rpy((Vector6() << x, 0, 0, 0, 0, 0).finished()), {}}; }

std::vector<std::uint32_t> epochs(const EarlierMaps& maps) {
  std::vector<std::uint32_t> list;
  for (const EarlierMap& map : maps.all()) list.push_back(map.epoch);
  return list;
}

TEST(EarlierMaps, TheLargestAreKept) {
  EarlierMaps maps;
  maps.keep(1, map_of(3));
  maps.keep(2, map_of(1));
  maps.keep(3, map_of(4));
  maps.keep(4, map_of(2));
  EXPECT_EQ(epochs(maps), (std::vector<std::uint32_t>{1, 3, 4}));
  EXPECT_EQ(maps.dropped(), 1U);
  maps.keep(5, map_of(0));
  EXPECT_EQ(epochs(maps), (std::vector<std::uint32_t>{1, 3, 4})) << "an empty one is none";
}

TEST(EarlierMaps, WhatALaterMapHasIsDroppedFirst) {
  EarlierMaps maps;
  for (std::uint32_t epoch : {1U, 2U, 3U}) maps.keep(epoch, map_of(static_cast<int>(9 - epoch)));
  maps.join(1, 4, ahead(1));
  maps.keep(4, map_of(1));
  EXPECT_EQ(epochs(maps), (std::vector<std::uint32_t>{2, 3, 4}));
  EXPECT_EQ(maps.dropped(), 0U) << "nothing is gone";
  EXPECT_TRUE(maps.between(4, 1)) << "its place is still known";
}

TEST(EarlierMaps, PlacesGoThroughTheMapsBetween) {
  EarlierMaps maps;
  maps.keep(1, map_of(1));
  maps.join(1, 2, ahead(3));
  maps.keep(2, map_of(1));
  EXPECT_FALSE(maps.between(3, 1));
  EXPECT_FALSE(maps.between(3, 2));
  maps.join(2, 3, ahead(4));
  ASSERT_TRUE(maps.between(3, 1));
  EXPECT_DOUBLE_EQ(maps.between(3, 1)->mean.translation().x(), 7);
  EXPECT_DOUBLE_EQ(maps.between(3, 2)->mean.translation().x(), 4);
  EXPECT_DOUBLE_EQ(maps.between(3, 3)->mean.translation().x(), 0);
}

}  // namespace
}  // namespace cairn
