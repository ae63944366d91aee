// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/map_voxels.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "onboard/mapping/files/point_file.hpp"
#include "tests/onboard/mapping/random_maps.hpp"

namespace cairn::matching {
namespace {

TEST(MapVoxels, AreTheCentresThatExportGives) {
  const auto map = mapping::random_map<mapping::SemanticOcTree>(3, 3000);
  const auto voxels = occupied_voxels(*map);
  const auto centres = mapping::occupied_voxel_centres(*map);
  ASSERT_TRUE(voxels && centres);
  ASSERT_EQ(voxels->size(), centres->size());
  for (std::size_t i = 0; i < voxels->size(); ++i) {
    const Voxel& v = (*voxels)[i];
    EXPECT_GE(v.occupancy, 0.5F);
    const auto* node = map->search(v.centre.x(), v.centre.y(), v.centre.z());
    ASSERT_NE(node, nullptr);
    EXPECT_FLOAT_EQ(static_cast<float>(node->getOccupancy()), v.occupancy);
  }
}

TEST(MapVoxels, TilesTogetherAreTheMapInOrder) {
  auto map = mapping::random_map<mapping::SemanticOcTree>(4, 3000);
  // A pruned cube of 16³ voxels is a leaf above the tiles.
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      for (int z = 0; z < 16; ++z) {
        const auto key = [](int k) { return static_cast<octomap::key_type>(32768 + 320 + k); };
        map->setNodeValue(octomap::OcTreeKey(key(x), key(y), key(z)), 2.0F, true);
      }
  map->canonicalise();
  const auto all = occupied_voxels(*map);
  ASSERT_TRUE(all);
  std::map<mapping::TileKey, std::size_t> tiles;
  for (const Voxel& v : *all) ++tiles[tile_of(v)];
  std::size_t at = 0;
  for (const auto& [tile, count] : tiles) {
    const auto some = occupied_voxels(*map, tile);
    ASSERT_EQ(some.size(), count);
    for (const Voxel& v : some) {
      EXPECT_EQ(v.key, (*all)[at].key);
      EXPECT_EQ(v.occupancy, (*all)[at++].occupancy);
    }
  }
  EXPECT_EQ(at, all->size());
  EXPECT_TRUE(occupied_voxels(*map, mapping::TileKey::of_voxel(5, 5, 5)).empty());
}

TEST(MapVoxels, TooManyAreAnErrorBeforeTheyAreListed) {
  mapping::SemanticOcTree map(0.1);
  bool made = false;
  map.root_or_new(made)->setLogOdds(2.0F);  // one leaf that claims 2⁴⁸ voxels
  map.settle_count();
  const auto voxels = occupied_voxels(map);
  ASSERT_FALSE(voxels);
  EXPECT_EQ(voxels.error().code, Errc::kLimit);
  EXPECT_TRUE(occupied_voxels(mapping::SemanticOcTree(0.1))->empty());
}

/// Of these voxels as of those of 0.1 m: two maps may have a surface in neighbouring voxels, however large.
class FreeSpaceOf : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Voxels, FreeSpaceOf, testing::Values(0.1, 0.2));

TEST_P(FreeSpaceOf, IsWhatWasSeenFreeAwayFromAnythingOccupied) {
  mapping::SemanticOcTree tree(GetParam());
  const mapping::SemanticOcTree* map = &tree;
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    const auto key = [&] { return static_cast<octomap::key_type>(32768 - 12 + static_cast<int>(random() % 24)); };
    tree.setNodeValue(octomap::OcTreeKey(key(), key(), key()), i % 100 == 0 ? 1.0F : -1.0F, true);
  }
  tree.canonicalise();
  const FreeSpace free(tree);
  const float edge = 14 * static_cast<float>(GetParam());
  std::uniform_real_distribution<float> at(-edge, edge);
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3f p(at(random), at(random), at(random));
    const auto* node = map->search(p.x(), p.y(), p.z());
    bool expected = node != nullptr && !map->isNodeOccupied(node);
    // The cube of 4 voxels that the tree has as one node.
    octomap::OcTreeKey key;
    ASSERT_TRUE(map->coordToKeyChecked(p.x(), p.y(), p.z(), key));
    for (int k = 0; k < 64 && expected; ++k) {
      const auto part = [](unsigned v, int offset) {
        return static_cast<octomap::key_type>((v & ~3U) + static_cast<unsigned>(offset));
      };
      const auto* other =
          map->search(octomap::OcTreeKey(part(key[0], k % 4), part(key[1], k / 4 % 4), part(key[2], k / 16)));
      expected = other == nullptr || !map->isNodeOccupied(other);
    }
    ASSERT_EQ(free.contains(p), expected) << p.transpose();
    found += expected ? 1 : 0;
  }
  EXPECT_GT(found, 100);
}

TEST(FreeSpace, AnyFloatIsSafe) {
  const auto map = mapping::random_map<mapping::SemanticOcTree>(5, 100);
  const FreeSpace free(*map);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30F, 3276.8F})
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3f p = Eigen::Vector3f::Zero();
      p[axis] = bad;
      EXPECT_FALSE(free.contains(p));
    }
  EXPECT_FALSE(FreeSpace(mapping::SemanticOcTree(0.1)).contains(Eigen::Vector3f::Zero()));
}

}  // namespace
}  // namespace cairn::matching
