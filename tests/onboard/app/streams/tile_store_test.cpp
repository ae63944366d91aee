// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/tile_store.hpp"

#include <gmock/gmock.h>

#include <random>

namespace cairn::app {
namespace {

using ::testing::ElementsAre;

TileStore::Tile stored_tile(std::uint64_t key, int value) {
  return {.key = key, .bytes = {static_cast<std::byte>(value)}};
}

std::vector<std::uint64_t> keys_after(const TileStore& store, std::uint64_t version) {
  std::vector<std::uint64_t> keys;
  for (const auto* tile = store.next_after(version); tile != nullptr; tile = store.next_after(tile->version))
    keys.push_back(tile->key);
  return keys;
}

TEST(TileStore, GivesTilesInTheOrderOfTheirLastChange) {
  TileStore store;
  for (const std::uint64_t key : {5U, 3U, 9U}) EXPECT_TRUE(store.put(stored_tile(key, 1)));
  EXPECT_THAT(keys_after(store, 0), ElementsAre(5, 3, 9));
  const std::uint64_t seen = store.version();
  EXPECT_TRUE(store.put(stored_tile(5, 2)));
  EXPECT_THAT(keys_after(store, 0), ElementsAre(3, 9, 5));
  EXPECT_THAT(keys_after(store, seen), ElementsAre(5));
  EXPECT_EQ(store.next_after(seen)->bytes[0], std::byte{2});
}

TEST(TileStore, ATileThatIsAsBeforeHasNotChanged) {
  TileStore store;
  EXPECT_TRUE(store.put(stored_tile(5, 1)));
  const std::uint64_t seen = store.version();
  EXPECT_TRUE(store.put(stored_tile(5, 1)));
  EXPECT_EQ(store.version(), seen);
  auto seen_by_two = stored_tile(5, 1);
  seen_by_two.contributors = {1, 2};
  EXPECT_TRUE(store.put(seen_by_two));
  EXPECT_THAT(keys_after(store, seen), ElementsAre(5));
}

TEST(TileStore, AnEmptyTileIsToldToThoseWhoHaveIt) {
  TileStore store;
  EXPECT_TRUE(store.put({.key = 4}));
  EXPECT_EQ(store.version(), 0U);  // nobody has it
  EXPECT_TRUE(store.put(stored_tile(4, 1)));
  EXPECT_TRUE(store.put({.key = 4}));
  EXPECT_THAT(keys_after(store, 1), ElementsAre(4));
}

TEST(TileStore, ANewMapIsEmptyAndVersionsGoOn) {
  TileStore store;
  EXPECT_TRUE(store.put(stored_tile(4, 1)));
  store.begin(0);
  EXPECT_EQ(store.size(), 1U);
  store.begin(1);
  EXPECT_EQ(store.size(), 0U);
  EXPECT_EQ(store.bytes(), 0U);
  EXPECT_TRUE(store.put(stored_tile(4, 1)));
  EXPECT_EQ(store.version(), 2U);
}

TEST(TileStore, MemoryIsBounded) {
  TileStore store(10'000);
  bool room = true;
  for (std::uint64_t key = 0; key < 1000; ++key) room = store.put(stored_tile(key, 1));
  EXPECT_FALSE(room);
  EXPECT_LE(store.bytes(), 10'000U);
  EXPECT_GT(store.size(), 20U);
  EXPECT_TRUE(store.put(stored_tile(0, 2)));  // what is there goes on
}

/// A reader that takes a few tiles at a time, whatever happens meanwhile, ends with the newest state of all.
TEST(TileStore, AReaderWithACursorEndsWithTheNewestState) {
  TileStore store;
  std::map<std::uint64_t, std::byte> truth, mirror;
  std::uint64_t cursor = 0;
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const std::uint64_t key = random() % 50;
    const int value = static_cast<int>(random() % 3);
    ASSERT_TRUE(store.put(stored_tile(key, value)));
    truth[key] = static_cast<std::byte>(value);
    if (random() % 4 != 0) continue;
    if (const auto* tile = store.next_after(cursor)) {
      mirror[tile->key] = tile->bytes[0];
      cursor = tile->version;
    }
  }
  for (const auto* tile = store.next_after(cursor); tile != nullptr; tile = store.next_after(tile->version))
    mirror[tile->key] = tile->bytes[0];
  EXPECT_EQ(mirror, truth);
}

}  // namespace
}  // namespace cairn::app
