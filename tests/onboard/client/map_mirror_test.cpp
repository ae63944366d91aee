// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/map_mirror.hpp"

#include <gmock/gmock.h>

#include "fusion/peers/items/tile_codec.hpp"

namespace cairn::client {
namespace {

using clients::TileMap;
using clients::TilesMessage;
using mapping::TileKey;

const TileKey kPillar = TileKey::of_voxel(32'768, 32'776, 32'768), kWall = TileKey::of_voxel(32'800, 32'776, 32'768);

mapping::TileState tile_state(unsigned x, float log_odds) {
  mapping::TileState state;
  for (unsigned z = 0; z < 8; ++z) state.set(x, 3, z, log_odds);
  return state;
}

TilesMessage::Tile tile_of(TileKey key, std::uint64_t version, const mapping::TileState& state) {
  TilesMessage::Tile tile{.key = key.morton, .version = version, .contributors = {1, 4}};
  tile.changed = Time{Duration{static_cast<std::int64_t>(version)}};
  if (!state.empty()) peers::encode_tile(state, tile.bytes);
  return tile;
}

TilesMessage record(std::vector<TilesMessage::Tile> tiles, std::uint64_t session = 7, std::uint32_t epoch = 0) {
  return {.map = TileMap::kOwn, .caught_up = true, .session = session, .epoch = epoch, .tiles = std::move(tiles)};
}

TEST(MapMirror, HasTheNewestStateOfEachTile) {
  MapMirror mirror(TileMap::kOwn, 0.2);
  ASSERT_TRUE(mirror.take(record({tile_of(kPillar, 1, tile_state(0, 3.5F)), tile_of(kWall, 2, tile_state(1, -1.6F))})));
  ASSERT_TRUE(mirror.take(record({tile_of(kPillar, 3, tile_state(2, 1.5F))})));
  EXPECT_EQ(mapping::read_tile(mirror.map(), kPillar), tile_state(2, 1.5F));
  EXPECT_EQ(mapping::read_tile(mirror.map(), kWall), tile_state(1, -1.6F));
  EXPECT_TRUE(mirror.caught_up());
  EXPECT_EQ(mirror.resume(), (clients::SubscribeMessage::Resume{7, 0, 3}));
  ASSERT_NE(mirror.origin_of(kPillar), nullptr);
  EXPECT_THAT(mirror.origin_of(kPillar)->robots, ::testing::ElementsAre(1, 4));
  EXPECT_EQ(mirror.origin_of(kPillar)->changed, Time{Duration{3}});
}

TEST(MapMirror, ForgetsATileOfWhichNothingIsKnown) {
  MapMirror mirror(TileMap::kOwn, 0.2);
  ASSERT_TRUE(mirror.take(record({tile_of(kPillar, 1, tile_state(0, 3.5F))})));
  ASSERT_TRUE(mirror.take(record({tile_of(kPillar, 2, {})})));
  EXPECT_EQ(mirror.tiles(), 0U);
  EXPECT_EQ(mirror.origin_of(kPillar), nullptr);
  EXPECT_EQ(mirror.map().size(), 0U);
}

TEST(MapMirror, AnotherSessionOrEpochBeginsAnew) {
  for (const auto& [session, epoch] : {std::pair{8U, 0U}, std::pair{7U, 1U}}) {
    MapMirror mirror(TileMap::kOwn, 0.2);
    ASSERT_TRUE(mirror.take(record({tile_of(kPillar, 50, tile_state(0, 3.5F))})));
    (void)mirror.take_changes();
    ASSERT_TRUE(mirror.take(record({tile_of(kWall, 1, tile_state(0, 3.5F))}, session, epoch)));
    EXPECT_EQ(mirror.tiles(), 1U);
    EXPECT_TRUE(mapping::read_tile(mirror.map(), kPillar).empty());
    const auto changes = mirror.take_changes();
    EXPECT_TRUE(changes.anew);
    EXPECT_THAT(changes.tiles, ::testing::ElementsAre(kWall));
  }
}

TEST(MapMirror, LeavesTheOtherMapAlone) {
  MapMirror mirror(TileMap::kTeam, 0.2);
  ASSERT_TRUE(mirror.take(record({tile_of(kPillar, 1, tile_state(0, 3.5F))})));
  EXPECT_EQ(mirror.tiles(), 0U);
  EXPECT_FALSE(mirror.caught_up());
}

TEST(MapMirror, ATileThatIsNoneIsRefusedAndAskedForAgain) {
  MapMirror mirror(TileMap::kOwn, 0.2);
  auto damaged = tile_of(kWall, 2, tile_state(0, 3.5F));
  damaged.bytes.resize(damaged.bytes.size() - 1);
  EXPECT_FALSE(mirror.take(record({tile_of(kPillar, 1, tile_state(0, 3.5F)), damaged})));
  EXPECT_EQ(mirror.resume().version, 1U);
  EXPECT_FALSE(mirror.caught_up());
  ASSERT_TRUE(mirror.take(record({tile_of(kWall, 2, tile_state(0, 3.5F))})));
  EXPECT_TRUE(mirror.caught_up());
  EXPECT_EQ(mirror.tiles(), 2U);
}

}  // namespace
}  // namespace cairn::client
