// SPDX-License-Identifier: Apache-2.0
// Oracles: OctoMap's search for reading, a plain map of tiles for writing.
#include "onboard/mapping/tree/tile_state.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::mapping {
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

/// With labels of some of its occupied voxels.
TileState labelled_state(std::mt19937& random) {
  TileState state = random_state(random);
  const auto kinds = 1 + random() % VoxelLabel::kCodes;
  std::vector<VoxelLabel> labels(512);
  for (std::size_t i = 0; i < 512; ++i)
    if ((state.occupied[i / 64] >> (i % 64) & 1U) != 0 && random() % 3 != 0)
      labels[i].code = static_cast<std::uint8_t>(1 + random() % kinds);
  state.set_labels(labels);
  return state;
}

TEST(TileState, LabelsComeBackFromTheMap) {
  std::mt19937 random(5);
  std::map<TileKey, TileState> oracle;
  SemanticOcTree map(0.1);
  std::size_t labelled = 0;
  for (int i = 0; i < 300; ++i) {
    const TileKey tile = random_tile(random);
    oracle[tile] = random() % 2 == 0 ? random_state(random) : labelled_state(random);
    if (oracle[tile].empty()) continue;
    ASSERT_TRUE(oracle[tile].valid());
    write_tile(map, tile, oracle[tile]);
    ASSERT_TRUE(map.is_canonical());
    ASSERT_EQ(read_tile(map, tile), oracle[tile]);
    labelled += oracle[tile].labels.empty() ? 0 : 1;
  }
  EXPECT_GT(labelled, 50U);
  for (const auto& [tile, state] : oracle) EXPECT_TRUE(state.empty() || read_tile(map, tile) == state);
}

TEST(TileState, OneLabelThroughoutIsOneNode) {
  TileState state;
  for (unsigned i = 0; i < 512; ++i) state.set(i % 8, i / 8 % 8, i / 64, 3.5F);
  state.set_labels(std::vector<VoxelLabel>(512, VoxelLabel::of(3, 1)));
  SemanticOcTree map(0.1), unlabelled(0.1);
  write_tile(map, {7}, state);
  EXPECT_EQ(read_tile(map, {7}), state);
  state.labels.clear();
  write_tile(unlabelled, {7}, state);
  EXPECT_EQ(map.size(), unlabelled.size());
  write_tile(map, {7}, state);
  EXPECT_TRUE(read_tile(map, {7}).labels.empty()) << "labels go with the state that had them";
}

TEST(TileState, TheRarestOfTooManyLabelsAreLeftOut) {
  TileState state;
  for (unsigned i = 0; i < 512; ++i) state.set(i % 8, i / 8 % 8, i / 64, 3.5F);
  std::vector<VoxelLabel> labels(512);
  for (unsigned i = 0; i < 512; ++i) labels[i].code = static_cast<std::uint8_t>(1 + (i < 40 ? i : i % 16));
  state.set_labels(labels);
  EXPECT_TRUE(state.valid());
  for (unsigned i = 40; i < 512; ++i) EXPECT_EQ(state.labels[i], labels[i]);
  for (unsigned i = 16; i < 40; ++i) EXPECT_FALSE(state.labels[i].any());
}

TEST(TileState, LabelsThatCannotBeAreNotValid) {
  TileState state;
  state.set(0, 0, 0, 2);
  state.set(1, 0, 0, -2);
  EXPECT_TRUE(state.valid());
  state.labels.assign(512, {});
  EXPECT_FALSE(state.valid()) << "no labels at all";
  state.labels[0] = VoxelLabel::of(18, 3);
  EXPECT_TRUE(state.valid());
  state.labels[0].code = 77;
  EXPECT_FALSE(state.valid());
  state.labels[0] = {};
  state.labels[1] = VoxelLabel::of(0, 0);
  EXPECT_FALSE(state.valid()) << "of what is free";
  state.labels.resize(3);
  EXPECT_FALSE(state.valid());
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

/// Voxel by voxel: the map's own word, where it has one, or else the other's.
TEST(TileState, FillingATileAddsOnlyWhatIsNotKnown) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    std::mt19937 random(seed);
    SemanticOcTree map(0.2), other(0.2);
    for (int i = 0; i < 200; ++i) write_tile(map, random_tile(random), random_state(random));
    for (int i = 0; i < 200; ++i) write_tile(other, random_tile(random), random_state(random));
    const SemanticOcTree before(map);
    std::size_t changed = 0;
    for (const TileKey tile : known_tiles(other, kAll)) changed += fill_tile(map, tile, other) ? 1 : 0;
    EXPECT_GT(changed, 0U);
    ASSERT_TRUE(map.is_canonical());
    ASSERT_EQ(map.size(), map.calcNumNodes());
    for (const TileKey tile : known_tiles(map, kAll)) {
      const TileState own = read_tile(before, tile), others = read_tile(other, tile), filled = read_tile(map, tile);
      for (unsigned i = 0; i < 512; ++i) {
        const unsigned x = i % 8, y = i / 8 % 8, z = i / 64;
        const TileState& source = own.log_odds(x, y, z) != SemanticNode::kAbsent ? own : others;
        ASSERT_EQ(filled.log_odds(x, y, z), source.log_odds(x, y, z));
        ASSERT_EQ(filled.label(x, y, z), source.label(x, y, z));
      }
    }
    for (const TileKey tile : known_tiles(other, kAll)) EXPECT_FALSE(fill_tile(map, tile, other)) << "again";
  }
}

}  // namespace
}  // namespace cairn::mapping
