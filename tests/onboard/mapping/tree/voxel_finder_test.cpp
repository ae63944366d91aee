// SPDX-License-Identifier: Apache-2.0
// The oracle is OctoMap's own search().
#include "onboard/mapping/tree/voxel_finder.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/mapping/random_maps.hpp"

namespace cairn::mapping {
namespace {

bool occupied_by_octomap(const SemanticOcTree& tree, const VoxelFinder::Key& key) {
  const auto part = [&](std::size_t a) { return static_cast<octomap::key_type>(key[a]); };
  const SemanticNode* node = tree.search(octomap::OcTreeKey(part(0), part(1), part(2)));
  return node != nullptr && tree.isNodeOccupied(*node);
}

TEST(VoxelFinder, FindsWhatOctoMapFinds) {
  std::size_t occupied = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {  // with pruned blocks that are free, occupied, and without
    const auto tree = random_map<SemanticOcTree>(seed, 3000);
    VoxelFinder finder(*tree);
    std::mt19937 random(seed);
    for (int i = 0; i < 20'000; ++i) {
      const int centre = i % 5 == 4 ? 0 : static_cast<int>(random() % 4) * 500 - 1000;
      const auto near = [&](int c) { return 32768 + c - 3 + static_cast<int>(random() % 15); };
      const VoxelFinder::Key key{near(centre), near(-centre), near(centre / 8)};
      finder.fetch_parents(key);
      finder.fetch_voxels(key);
      ASSERT_EQ(finder.occupied(key), occupied_by_octomap(*tree, key)) << seed << " " << i;
      occupied += finder.occupied(key) ? 1 : 0;
    }
  }
  EXPECT_GT(occupied, 4000U);
}

TEST(VoxelFinder, OfManyBricksEachIsFoundAgain) {
  SemanticOcTree tree(0.1);
  for (int i = 0; i < 3000; ++i)  // more bricks than it remembers at once
    tree.updateNode(octomap::OcTreeKey(static_cast<octomap::key_type>(20 * i), 40'000, 77), true);
  VoxelFinder finder(tree);
  for (int repeat = 0; repeat < 2; ++repeat)
    for (int i = 0; i < 3000; ++i) {
      ASSERT_TRUE(finder.occupied({20 * i, 40'000, 77})) << i;
      ASSERT_FALSE(finder.occupied({20 * i + 1, 40'000, 77})) << i;
    }
}

TEST(VoxelFinder, WhatIsFetchedBeyondTheEdgeConfusesNothing) {
  SemanticOcTree tree(0.1);
  tree.updateNode(octomap::OcTreeKey(0, 16, 0), true);
  VoxelFinder finder(tree);
  finder.fetch_voxels({65536, 0, 0});
  EXPECT_TRUE(finder.occupied({0, 16, 0}));
  EXPECT_FALSE(finder.occupied({0, 0, 0}));
}

TEST(VoxelFinder, AnEmptyMapHasNothing) {
  const SemanticOcTree tree(0.1);
  VoxelFinder finder(tree);
  EXPECT_FALSE(finder.occupied({32768, 32768, 32768}));
  EXPECT_FALSE(finder.occupied({0, 0, 0}));
  EXPECT_FALSE(finder.occupied({65535, 65535, 65535}));
}

}  // namespace
}  // namespace cairn::mapping
