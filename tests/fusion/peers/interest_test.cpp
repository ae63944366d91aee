// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/interest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "fusion/peers/items/tile_codec.hpp"
#include "tests/fusion/peers/tile_states.hpp"

namespace cairn::peers {
namespace {

mapping::TileKey at(int x, int y, int z) {
  const auto voxel = [](int tiles) { return static_cast<std::uint16_t>(32768 + 8 * tiles); };
  return mapping::TileKey::of_voxel(voxel(x), voxel(y), voxel(z));
}

std::vector<std::byte> payload_of(float log_odds) {
  mapping::TileState state;
  state.set(3, 4, 5, log_odds);
  std::vector<std::byte> bytes;
  encode_tile(state, bytes);
  return bytes;
}
const std::vector<std::byte> kWall = payload_of(2), kFree = payload_of(-2);

ItemUpdate update(mapping::TileKey tile, Version version, const std::vector<std::byte>& payload) {
  return {ItemId::tile(0, tile), version, 0, payload};
}

std::vector<Version> sorted(const Interest& interest, std::vector<ItemUpdate> updates) {
  interest.sort(updates);
  std::vector<Version> versions;
  for (const ItemUpdate& update : updates) versions.push_back(update.version);
  return versions;
}

TEST(Interest, GoesFromClaimsToNearWallsToTheRestByAge) {
  Interest interest;
  interest.position_odom = Eigen::Vector3d(16.1, -3, 0.5);  // tile 10, −2, 0
  EXPECT_EQ(sorted(interest, {update(at(90, 0, 0), 1, kFree),
                              update(at(10, -2, 0), 2, kFree),
                              update(at(90, 0, 0), 3, kWall),
                              update(at(14, -2, 0), 4, kWall),
                              update(at(10, -2, 0), 5, kWall),
                              {ItemId::edge(1), 6, 0, {}}}),
            (std::vector<Version>{6, 5, 4, 3, 1, 2}));
}

TEST(Interest, WallsOvertakeALittle) {
  std::vector<ItemUpdate> updates;
  for (int i = 1; i <= 100; ++i)
    updates.push_back(update(at(i, 0, 0), static_cast<Version>(i), i % 2 == 0 ? kWall : kFree));
  const auto versions = sorted(Interest{}, updates);
  EXPECT_EQ(versions.front(), 2U);
  std::size_t most_gaps = 0;
  VersionSet known;
  for (const Version version : versions) {
    known.add({version, version});
    most_gaps = std::max(most_gaps, known.ranges().size());
  }
  EXPECT_LE(most_gaps, 17U) << "a set of versions has 64 ranges at most";
  EXPECT_TRUE(known.complete(100));
}

TEST(Interest, WhatIsNearIsBoundedAndAroundThePosition) {
  Interest interest;
  interest.position_odom = Eigen::Vector3d(16.1, -3, 0.5);
  const auto near = interest.near_by();
  EXPECT_LE(near.size(), 1000U);
  EXPECT_NE(std::ranges::find(near, ItemId::tile(0, at(10, -2, 0))), near.end());
  EXPECT_NE(std::ranges::find(near, ItemId::tile(0, at(13, -4, 1))), near.end());
  EXPECT_EQ(std::ranges::find(near, ItemId::tile(0, at(20, -2, 0))), near.end());
  for (const ItemId id : near) EXPECT_TRUE(id.valid());
  for (const double far : {1e5, -1e6, std::numeric_limits<double>::infinity()}) {
    interest.position_odom = Eigen::Vector3d(far, 0, 0);
    EXPECT_TRUE(interest.near_by().empty()) << "beyond any map";
    EXPECT_EQ(sorted(interest, {update(at(0, 0, 0), 1, kWall)}).size(), 1U);
  }
}

TEST(Interest, WallsAreToldFromFreeSpaceByTheBytes) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const mapping::TileState state = i % 2 == 0 ? random_tile_state(random) : wall_tile_state(random);
    if (state.empty()) continue;
    std::vector<std::byte> bytes;
    encode_tile(state, bytes);
    EXPECT_EQ(has_occupied(bytes), state.any_occupied());
  }
}

}  // namespace
}  // namespace cairn::peers
