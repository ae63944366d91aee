// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/tile_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace cairn::merging {
namespace {

float value_at(const mapping::SemanticOcTree& map, const Eigen::Vector3i& key) {
  const auto part = [&](int axis) { return static_cast<octomap::key_type>(key[axis]); };
  const mapping::SemanticNode* node = map.search(octomap::OcTreeKey(part(0), part(1), part(2)));
  return node == nullptr ? mapping::SemanticNode::kAbsent : node->getLogOdds();
}

void set_voxel(mapping::SemanticOcTree& map, const Eigen::Vector3i& key, float log_odds) {
  const auto part = [&](int axis) { return static_cast<octomap::key_type>(key[axis]); };
  map.setNodeValue(octomap::OcTreeKey(part(0), part(1), part(2)), log_odds);
}

int index_of(const Eigen::Vector3i& key) {
  return mapping::tile_index(0, key.x() & 7) + mapping::tile_index(1, key.y() & 7) +
         mapping::tile_index(2, key.z() & 7);
}

/// Few different values, so that cubes of equal voxels are collapsed on every level.
mapping::TileVoxels random_voxels(std::mt19937& random) {
  const std::array values{mapping::SemanticNode::kAbsent, -1.0F, 2.0F};
  mapping::TileVoxels tile;
  for (const int run : {64, 8, 1})
    for (int from = 0; from < mapping::kTileVoxels; from += run)
      if (run == 64 || random() % 3 == 0) std::fill_n(tile.begin() + from, run, values.at(random() % values.size()));
  return tile;
}

TEST(TileVoxels, WhatIsWrittenIsThereInTheTreeAndIsReadAgain) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    mapping::TileVoxels tile = random_voxels(random), read;
    if (round == 0) tile.fill(2.0F);
    mapping::SemanticOcTree map(0.1);
    set_voxel(map, {32760, 32760, 32760}, 0);  // nodes down to the tile, which is then emptied
    mapping::SemanticNode* leaf = map.getRoot();
    bool made = false;
    for (int depth = 0; depth < 13; ++depth) leaf = map.writer(0).child(leaf, depth == 0 ? 0 : 7, made);
    map.writer(0).free_below(leaf);
    map.writer(0).count(-3);
    ASSERT_TRUE(mapping::write_voxels(tile, map.writer(0), leaf));
    map.settle_count();
    mapping::read_voxels(*leaf, read);
    EXPECT_EQ(read, tile);
    map.canonicalise();
    EXPECT_EQ(map.size(), map.calcNumNodes());
    for (int i = 0; i < mapping::kTileVoxels; ++i) {
      const Eigen::Vector3i key(32760 + (i & 7), 32760 + (i >> 3 & 7), 32760 + (i >> 6));
      ASSERT_EQ(value_at(map, key), tile.at(static_cast<std::size_t>(index_of(key))));
    }
  }
}

TEST(TileVoxels, OfNothingKnownNothingIsWritten) {
  mapping::SemanticOcTree map(0.1);
  bool made = false;
  mapping::SemanticNode* root = map.root_or_new(made);
  mapping::TileVoxels tile;
  tile.fill(mapping::SemanticNode::kAbsent);
  EXPECT_FALSE(mapping::write_voxels(tile, map.writer(0), root));
  EXPECT_EQ(root->block(), nullptr);
}

/// Tiles that share a place of the window, the tree's corners and what lies beyond them.
TEST(TileWindow, HoldsWhatTheTreeHasWhateverWasHeldBefore) {
  std::mt19937 random(2);
  const std::array coordinates{0, 5, 32767, 32768, 32768 + 9, 32768 + 128, 32768 + 129, 65535};
  const auto any = [&] { return coordinates.at(random() % coordinates.size()); };
  mapping::SemanticOcTree map(0.1);
  for (int i = 0; i < 200; ++i) set_voxel(map, {any(), any(), any()}, static_cast<float>(random() % 5) - 2.0F);
  TileWindow window(map.getRoot());
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3i key(any(), any(), any()), tile = key.array() / mapping::kTileEdge;
    window.hold(tile.array() - 1, tile.array() + 1);
    const auto held = [&](const Eigen::Vector3i& k) {
      return window.voxels()[TileWindow::index(0, k.x()) + TileWindow::index(1, k.y()) + TileWindow::index(2, k.z())];
    };
    ASSERT_EQ(held(key), value_at(map, key)) << key.transpose();
    const Eigen::Vector3i beside = key.array() + static_cast<int>(random() % 17) - 8;
    const bool outside = (beside.array() < 0).any() || (beside.array() > 65535).any();
    ASSERT_EQ(held(beside), outside ? mapping::SemanticNode::kAbsent : value_at(map, beside)) << beside.transpose();
  }
}

TEST(TileWindow, OfAnEmptyMapNothingIsKnown) {
  TileWindow window(nullptr);
  window.hold({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(window.voxels()[0], mapping::SemanticNode::kAbsent);
}

}  // namespace
}  // namespace cairn::merging
