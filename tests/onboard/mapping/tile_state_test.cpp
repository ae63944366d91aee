// SPDX-License-Identifier: Apache-2.0
// Oracles: OctoMap's search for reading, a plain map of tiles for writing.
#include "onboard/mapping/tile_state.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn {
namespace {

constexpr std::size_t kAll = 1U << 20U;

/// A tile in which each voxel is unknown, free or occupied; or all of one kind.
TileState random_state(std::mt19937& random) {
  TileState state;
  const unsigned kind = random() % 4;
  for (unsigned z = 0; z < 8; ++z)
    for (unsigned y = 0; y < 8; ++y)
      for (unsigned x = 0; x < 8; ++x) {
        if (kind == 0)
          state.set(x, y, z, -2);
        else if (random() % kind == 0)
          state.set(x, y, z, std::uniform_real_distribution<float>(-2, 3.5)(random));
      }
  return state;
}

TileKey random_tile(std::mt19937& random) {
  const auto near = [&] { return static_cast<std::uint16_t>(32768 + 8 * (random() % 4)); };
  return TileKey::of_voxel(near(), near(), near());
}

TEST(TileState, ReadsWhatOctoMapFinds) {
  const auto map = random_map<SemanticOcTree>(3, 3000);
  saturate_block(*map, true);
  std::size_t known = 0;
  for (const TileKey tile : known_tiles(*map, kAll)) {
    const TileState state = read_tile(*map, tile);
    EXPECT_TRUE(state.valid());
    EXPECT_FALSE(state.empty());
    for (unsigned z = 0; z < 8; ++z)
      for (unsigned y = 0; y < 8; ++y)
        for (unsigned x = 0; x < 8; ++x) {
          const auto key = [&](unsigned axis, unsigned i) {
            return static_cast<std::uint16_t>(tile.first_voxel(axis) + i);
          };
          const SemanticNode* node = map->search(octomap::OcTreeKey(key(0, x), key(1, y), key(2, z)));
          const float read = state.log_odds(x, y, z);
          ASSERT_EQ(read == SemanticNode::kAbsent, node == nullptr);
          if (node == nullptr) continue;
          ++known;
          ASSERT_EQ(read >= 0, map->isNodeOccupied(node));
          ASSERT_LE(std::abs(read - node->getLogOdds()), 1.0F);
        }
  }
  std::size_t voxels = 0;
  for (auto leaf = map->begin_leafs(); leaf != map->end_leafs(); ++leaf)
    voxels += std::size_t{1} << 3 * (SemanticOcTree::kDepth - leaf.getDepth());
  EXPECT_EQ(known, voxels);
}

TEST(TileState, GradesComeBackAsTheyAre) {
  TileState state;
  for (const float value : {-1.6F, -0.4F, 0.5F, 1.5F, 2.5F, 3.5F}) {
    state.set(1, 2, 3, value);
    EXPECT_EQ(state.log_odds(1, 2, 3), value);
    EXPECT_TRUE(state.valid());
  }
  state.set(1, 2, 3, -0.01F);
  EXPECT_EQ(state.log_odds(1, 2, 3), -0.4F);
  state.set(1, 2, 3, 0);
  EXPECT_EQ(state.log_odds(1, 2, 3), 0.5F);
  EXPECT_EQ(state.log_odds(1, 2, 4), SemanticNode::kAbsent);
}

TEST(TileState, SaysWhatPlanesCannotBe) {
  TileState unknown_but_occupied, no_such_grade;
  unknown_but_occupied.occupied[2] = 1;
  no_such_grade.known[0] = no_such_grade.high[0] = 1;
  EXPECT_FALSE(unknown_but_occupied.valid());
  EXPECT_FALSE(no_such_grade.valid());
  no_such_grade.occupied[0] = 1;
  EXPECT_TRUE(no_such_grade.valid());
}

TEST(TileState, WrittenTilesAreReadBackAndTheTreeStaysSound) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    SemanticOcTree map(0.2);
    std::map<TileKey, TileState> oracle;
    for (int i = 0; i < 300; ++i) {
      const TileKey tile = random_tile(random);
      const TileState state = random() % 3 == 0 ? TileState{} : random_state(random);
      write_tile(map, tile, state);
      if (state.empty())
        oracle.erase(tile);
      else
        oracle[tile] = state;
      ASSERT_EQ(map.size(), map.calcNumNodes());
    }
    ASSERT_TRUE(map.is_canonical());
    std::vector<TileKey> keys;
    for (const auto& [tile, state] : oracle) {
      keys.push_back(tile);
      ASSERT_EQ(read_tile(map, tile), state);
    }
    EXPECT_EQ(known_tiles(map, kAll), keys);
    for (const auto& [tile, state] : oracle) write_tile(map, tile, TileState{});
    EXPECT_EQ(map.size(), 0U);
  }
}

TEST(TileState, TheOrderOfWritingDoesNotMatter) {
  std::mt19937 random(9);
  std::map<TileKey, TileState> tiles;
  for (int i = 0; i < 60; ++i) tiles[random_tile(random)] = random_state(random);
  SemanticOcTree up(0.2), down(0.2);
  for (const auto& [tile, state] : tiles) write_tile(up, tile, state);
  for (auto it = tiles.rbegin(); it != tiles.rend(); ++it) write_tile(down, it->first, it->second);
  EXPECT_EQ(differing_nodes(up, down), 0U);
}

TEST(TileState, ALeafAboveTheTileIsTakenApart) {
  SemanticOcTree map(0.2);
  for (unsigned i = 0; i < 8; ++i) {
    TileState free;
    for (TileState::Plane::value_type& plane : free.known) plane = ~std::uint64_t{0};
    write_tile(map, {i}, free);
  }
  EXPECT_EQ(known_tiles(map, kAll).size(), 8U);
  EXPECT_EQ(map.size(), 13U);  // the eight are one leaf, at depth 12
  write_tile(map, TileKey{3}, TileState{});
  EXPECT_EQ(known_tiles(map, kAll).size(), 7U);
  EXPECT_EQ(known_tiles(map, 5).size(), 5U);
}

}  // namespace
}  // namespace cairn
