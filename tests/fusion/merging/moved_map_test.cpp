// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/moved_map.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include "onboard/mapping/tree/tile_state.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::merging {
namespace {

using mapping::SemanticOcTree;
using mapping::TileKey;

constexpr double kVoxel = 0.1;

/// A map in the grades of tiles, some of its occupied voxels with labels.
std::unique_ptr<SemanticOcTree> some_map(unsigned seed) {
  const auto raw = mapping::random_map<SemanticOcTree>(seed, 3000, kVoxel);
  auto map = std::make_unique<SemanticOcTree>(kVoxel);
  std::mt19937 random(seed);
  for (const TileKey tile : mapping::known_tiles(*raw, std::numeric_limits<std::size_t>::max())) {
    mapping::TileState state = mapping::read_tile(*raw, tile);
    std::vector<mapping::VoxelLabel> labels(mapping::kTileVoxels);
    for (std::size_t i = 0; i < labels.size(); ++i)
      if ((state.occupied[i / 64] >> (i % 64) & 1U) != 0 && random() % 2 == 0)
        labels[i] = mapping::VoxelLabel::from_id(static_cast<std::uint8_t>(1 + random() % 3));
    state.set_labels(std::move(labels));
    mapping::write_tile(*map, tile, state);
  }
  return map;
}

SE3 pose(double x, double y, double z, double yaw) {
  return SE3::from_xyz_rpy((Vector6() << x, y, z, 0, 0, yaw).finished());
}

/// Nodes and labels.
bool equal(const SemanticOcTree& a, const SemanticOcTree& b) {
  if (mapping::differing_nodes(a, b) != 0) return false;
  auto x = a.begin_leafs(), y = b.begin_leafs();
  for (; x != a.end_leafs(); ++x, ++y)
    if (x->label_id() != y->label_id()) return false;
  return true;
}

TEST(MovedMap, StaysWhatItIsWhereItStays) {
  for (unsigned seed = 1; seed < 5; ++seed) {
    const auto map = some_map(seed);
    const auto moved = moved_map(*map, SE3());
    ASSERT_TRUE(moved);
    EXPECT_TRUE((*moved)->is_canonical());
    EXPECT_TRUE(equal(**moved, *map));
  }
}

TEST(MovedMap, WholeVoxelsAndRightAnglesComeBackExactly) {
  const auto map = some_map(2);
  for (const SE3& there : {pose(3 * kVoxel, -17 * kVoxel, kVoxel, 0), pose(0, 0, 0, std::numbers::pi / 2)}) {
    const auto moved = moved_map(*map, there);
    ASSERT_TRUE(moved);
    EXPECT_FALSE(equal(**moved, *map));
    const auto back = moved_map(**moved, there.inverse());
    ASSERT_TRUE(back);
    EXPECT_TRUE(equal(**back, *map));
  }
}

/// Each voxel of the new grid knows what the map knows where its centre was.
TEST(MovedMap, AsksTheMapWhereTheCentreWas) {
  const auto map = some_map(3);
  const SE3 T = pose(0.43, -1.27, 0.061, 0.7);
  const auto moved = moved_map(*map, T);
  ASSERT_TRUE(moved);
  std::size_t voxels = 0;
  for (auto leaf = (*moved)->begin_leafs(); leaf != (*moved)->end_leafs(); ++leaf) {
    if (leaf.getDepth() != SemanticOcTree::kDepth) continue;
    const Eigen::Vector3d there = T.inverse() * Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ());
    const auto* node = map->search(there.x(), there.y(), there.z());
    ASSERT_NE(node, nullptr);
    EXPECT_EQ(node->getLogOdds(), leaf->getLogOdds());
    EXPECT_EQ(node->label_id(), leaf->label_id());
    ++voxels;
  }
  EXPECT_GT(voxels, 500U);
}

TEST(MovedMap, APoseOutOfTheTreeIsRefused) {
  const auto map = some_map(1);
  EXPECT_FALSE(moved_map(*map, pose(1e9, 0, 0, 0)));
  EXPECT_FALSE(moved_map(*map, pose(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0)));
}

}  // namespace
}  // namespace cairn::merging
