// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_tiles.hpp"

#include <gtest/gtest.h>

namespace cairn::peers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kScan = milliseconds(100);
/// 5 s where 64 voxels are new (32 the first time), up to a minute where it is fewer.
constexpr OwnTilesConfig kConfig{milliseconds(500), seconds(5), 32, 64, seconds(60), 3, seconds(1), seconds(1000)};

/// A tile of which so many voxels are free.
mapping::TileState free_voxels(unsigned count) {
  mapping::TileState state;
  for (unsigned i = 0; i < count; ++i) state.set(i % 8, i / 8 % 8, i / 64, mapping::TileState::kFree[0]);
  return state;
}

/// A robot and one tile of its map, in virtual time.
struct OneTile {
  explicit OneTile(const OwnTilesConfig& config = kConfig) : tiles(config) {}

  void see(unsigned count) { tiles.observe({7}, free_voxels(count), now); }
  /// How often the tile is said; `seeing`: so many free voxels are seen with every scan.
  Version said_in(Duration length, unsigned seeing = 0) {
    const Version before = own.layers().at(1).holding.newest();
    for (const Time end = now + length; now < end; now += kScan) {
      if (seeing > 0) see(seeing);
      tiles.say(own, now);
    }
    return own.layers().at(1).holding.newest() - before;
  }
  /// What remains of the time that the tile waits to be said, to the second.
  seconds wait() {
    for (int s = 1; s < 1000; ++s)
      if (said_in(seconds(1)) > 0) return seconds(s);
    return seconds(0);
  }

  Exchange own{1, "one", 5};
  OwnTiles tiles;
  Time now{};
};

TEST(OwnTiles, SaysATileSoonAfterItWasFirstSeen) {
  OneTile tile;
  EXPECT_EQ(tile.said_in(milliseconds(400), 100), 0U);
  EXPECT_EQ(tile.said_in(milliseconds(1100), 100), 1U);  // half a second, and until the next round
  EXPECT_EQ(tile.said_in(seconds(100), 100), 0U);        // there is no news in it
}

TEST(OwnTiles, TheLessIsNewTheLongerATileWaits) {
  OneTile tile;
  tile.see(100);
  EXPECT_LE(tile.wait(), seconds(2));
  const std::vector<std::pair<unsigned, seconds>> cases{
      {100 + 32, seconds(5)}, {132 + 332, seconds(5)}, {464 + 16, seconds(20)}, {480 + 1, seconds(60)}};
  for (const auto& [count, least] : cases) {
    tile.see(count);
    const auto wait = tile.wait();
    EXPECT_GE(wait, least) << count;
    EXPECT_LE(wait, least + seconds(2)) << count;
  }
}

TEST(OwnTiles, ATileThatGoesOnChangingIsSaidToo) {
  OneTile tile;
  EXPECT_EQ(tile.said_in(seconds(2), 100), 1U);
  EXPECT_EQ(tile.said_in(seconds(12), 200), 0U);
  EXPECT_EQ(tile.said_in(seconds(5), 200), 1U);  // 3 · 5 s after the change began
}

TEST(OwnTiles, WhenNothingChangesAnyMoreWhateverWaitsIsSaid) {
  OneTile tile{OwnTilesConfig{}};
  EXPECT_EQ(tile.said_in(seconds(2), 100), 1U);
  tile.see(101);
  EXPECT_EQ(tile.said_in(seconds(4)), 0U);
  EXPECT_EQ(tile.said_in(seconds(3)), 1U);
}

TEST(OwnTiles, SaysATileSoonAgainInANewEpoch) {
  OneTile tile;
  EXPECT_EQ(tile.said_in(seconds(50), 100), 1U);
  tile.own.begin(6);
  EXPECT_EQ(tile.said_in(seconds(2), 100), 1U);
}

TEST(OwnTiles, AChangeCountsVoxelsThatChangedSidesAndLessThoseThatBecameSurer) {
  mapping::TileState sure = free_voxels(8), weak;
  for (unsigned i = 0; i < 8; ++i) weak.set(i, 0, 0, mapping::TileState::kFree[1]);
  mapping::TileState wall;
  for (unsigned i = 0; i < 8; ++i) wall.set(i, 0, 0, mapping::TileState::kOccupied[0]);
  EXPECT_EQ(change_between(sure, sure), 0);
  EXPECT_EQ(change_between({}, sure), 8);
  EXPECT_EQ(change_between(sure, wall), 8);
  EXPECT_EQ(change_between(weak, sure), 2);
  mapping::TileState labelled = wall;
  std::vector<mapping::VoxelLabel> labels(512);
  labels[3] = mapping::VoxelLabel::of(2, 0);
  labelled.set_labels(labels);
  EXPECT_EQ(change_between(wall, labelled), 1);
  EXPECT_EQ(change_between(labelled, labelled), 0);
}

}  // namespace
}  // namespace cairn::peers
