// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/tiles.hpp"

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

TilesMessage::Tile some_tile(std::uint64_t version) {
  return {.key = 1000 - version,
          .version = version,
          .changed = Time{Duration{static_cast<std::int64_t>(version)}},
          .contributors = {1, 70'000},
          .bytes = std::vector<std::byte>(100, std::byte{7})};
}

/// A whole record of tiles with these versions; `taken` is how many found room.
std::vector<std::byte> record_of(std::uint64_t tiles, std::size_t& taken) {
  std::vector<std::byte> out;
  TilesWriter writer({.map = TileMap::kTeam, .session = 5, .epoch = 2}, 9, out);
  for (std::uint64_t version = 1; version <= tiles && writer.add(some_tile(version)); ++version) continue;
  taken = writer.tiles();
  writer.finish(taken == tiles);
  return out;
}

TEST(TilesMessage, ComesBackAsItWasSent) {
  std::size_t taken = 0;
  const auto message = record_of(3, taken);
  const auto record = decode_record(message);
  ASSERT_TRUE(record) << to_string(record.error());
  EXPECT_EQ(record->sequence, 9U);
  const auto got = decode_tiles(record->body);
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->map, TileMap::kTeam);
  EXPECT_TRUE(got->caught_up);
  EXPECT_EQ(got->session, 5U);
  EXPECT_EQ(got->epoch, 2U);
  ASSERT_EQ(got->tiles.size(), 3U);
  for (std::uint64_t i = 0; i < 3; ++i) {
    const TilesMessage::Tile expected = some_tile(i + 1);
    EXPECT_EQ(got->tiles[i].key, expected.key);
    EXPECT_EQ(got->tiles[i].version, expected.version);
    EXPECT_EQ(got->tiles[i].changed, expected.changed);
    EXPECT_EQ(got->tiles[i].contributors, expected.contributors);
    EXPECT_EQ(got->tiles[i].bytes, expected.bytes);
  }
  test::expect_exact({record->body.begin(), record->body.end()}, decode_tiles);
}

TEST(TilesMessage, MayHoldNone) {
  std::size_t taken = 0;
  const auto got = decode_tiles(decode_record(record_of(0, taken))->body);
  ASSERT_TRUE(got);
  EXPECT_TRUE(got->tiles.empty());
  EXPECT_TRUE(got->caught_up);
}

TEST(TilesMessage, ARecordTakesWhatFits) {
  std::size_t taken = 0;
  const auto message = record_of(1000, taken);
  EXPECT_GT(taken, 200U);
  EXPECT_LT(taken, 1000U);
  const auto got = decode_tiles(decode_record(message)->body);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->tiles.size(), taken);
  EXPECT_FALSE(got->caught_up);
}

TEST(TilesMessage, VersionsAndContributorsAscend) {
  std::vector<std::byte> out;
  TilesWriter same({}, 0, out);
  EXPECT_TRUE(same.add(some_tile(1)) && same.add(some_tile(1)));
  same.finish(true);
  EXPECT_FALSE(decode_tiles(decode_record(out)->body));
  TilesWriter twice({}, 0, out);
  auto tile = some_tile(1);
  tile.contributors = {4, 4};
  EXPECT_TRUE(twice.add(tile));
  twice.finish(true);
  EXPECT_FALSE(decode_tiles(decode_record(out)->body));
}

}  // namespace
}  // namespace cairn::clients
