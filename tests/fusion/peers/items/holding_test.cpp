// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/holding.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::peers {
namespace {

constexpr std::size_t kAll = std::size_t{1} << 30U;  // bytes

std::vector<std::byte> payload(unsigned long value) {
  return std::vector<std::byte>(1 + value % 40, static_cast<std::byte>(value));
}

ItemId item(unsigned long i) { return ItemId::tile(static_cast<std::uint16_t>(i % 3), {i}); }

std::vector<ItemUpdate> missing(const Holding& from, const Holding& at, std::size_t most = 10000) {
  return from.missing(at.known(), most).updates;
}

/// Everything arrives.
void bring_up_to_date(const Holding& from, Holding& to) {
  const Missing missing = from.missing(to.known(), 10000);
  for (const ItemUpdate& update : missing.updates) to.take(update, kAll);
  to.settle(missing.superseded);
}

bool same(const Holding& a, const Holding& b) {
  if (a.items().size() != b.items().size()) return false;
  for (const auto& [id, held] : a.items()) {
    const auto other = b.items().find(id);
    if (other == b.items().end() || other->first != id || other->second.version != held.version ||
        other->second.payload != held.payload)
      return false;
  }
  return true;
}

TEST(Holding, SayingTheSameIsNoNews) {
  Holding own;
  EXPECT_TRUE(own.say(item(1), payload(5)));
  EXPECT_FALSE(own.say(item(1), payload(5)));
  EXPECT_EQ(own.newest(), 1U);
  EXPECT_TRUE(own.say(item(1), payload(6)));
  EXPECT_EQ(own.newest(), 2U);
  EXPECT_EQ(own.items().size(), 1U);
}

/// Updates that are lost, repeated, late and in any order; whatever a holding says it knows, it knows.
TEST(Holding, ComesToTheSameWhateverHappensOnTheWay) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    Holding own, peer;
    std::vector<std::pair<ItemUpdate, std::vector<std::byte>>> on_the_way;
    for (int step = 0; step < 200; ++step) {
      own.say(item(random() % 30), payload(random() % 100));
      for (const ItemUpdate& update : missing(own, peer, 1 + random() % 10))
        on_the_way.push_back({update, {update.payload.begin(), update.payload.end()}});
      for (int i = 0; i < 4 && !on_the_way.empty(); ++i) {
        auto& [update, bytes] = on_the_way[random() % on_the_way.size()];
        update.payload = bytes;
        peer.take(update, kAll);  // and may come again
      }
      for (const VersionRange& range : peer.known().ranges())
        for (const auto& [id, held] : own.items()) {
          if (held.version < range.first || held.version > range.last) continue;
          ASSERT_EQ(peer.items().at(id).version, held.version);
        }
    }
    bring_up_to_date(own, peer);
    EXPECT_TRUE(same(own, peer));
    EXPECT_TRUE(peer.known().complete(own.newest()));
    EXPECT_EQ(peer.known().ranges().size(), 1U);
  }
}

/// A robot says its tiles in whatever submap it is in.
TEST(Holding, ATileIsHeldInTheSubmapItWasSaidInLastWhateverArrivesWhen) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    Holding own, peer;
    std::map<mapping::TileKey, ItemId> last;
    std::vector<std::pair<ItemUpdate, std::vector<std::byte>>> on_the_way;
    for (unsigned step = 0; step < 300; ++step) {
      const auto submap = static_cast<std::uint16_t>(step / 60);
      const ItemId id = ItemId::tile(submap, {random() % 20});
      if (own.say(id, payload(step))) last[id.tile()] = id;
      for (const ItemUpdate& update : missing(own, peer, 1 + random() % 5))
        on_the_way.push_back({update, {update.payload.begin(), update.payload.end()}});
      auto& [update, bytes] = on_the_way[random() % on_the_way.size()];
      update.payload = bytes;
      peer.take(update, kAll);
    }
    bring_up_to_date(own, peer);
    EXPECT_TRUE(same(own, peer));
    EXPECT_EQ(peer.items().size(), last.size());
    EXPECT_EQ(peer.bytes(), own.bytes());
    for (const auto& [tile, id] : last) EXPECT_EQ(peer.items().find(ItemId::tile(0, tile))->first, id);
  }
}

TEST(Holding, WhoRelaysClaimsNoMoreThanItKnows) {
  std::mt19937 random(7);
  Holding own, relay, last;
  for (int step = 0; step < 500; ++step) {
    own.say(item(random() % 20), payload(random() % 100));
    for (const ItemUpdate& update : missing(own, relay))
      if (random() % 3 == 0) relay.take(update, kAll);
    const Missing behind = relay.missing(last.known(), 1 + random() % 10);
    for (const ItemUpdate& update : behind.updates)
      if (random() % 3 == 0) last.take(update, kAll);
    if (random() % 3 == 0) last.settle(behind.superseded);
    for (const VersionRange& range : last.known().ranges())
      for (const auto& [id, held] : own.items())
        if (held.version >= range.first && held.version <= range.last) {
          ASSERT_EQ(last.items().at(id).version, held.version);
        }
  }
  bring_up_to_date(own, relay);
  bring_up_to_date(relay, last);
  EXPECT_TRUE(same(own, last));
  EXPECT_TRUE(last.known().complete(own.newest()));
}

TEST(Holding, TakesNoMoreThanItMay) {
  constexpr std::size_t kMost = 4000;
  Holding own, peer;
  for (unsigned i = 0; i < 100; ++i) own.say(item(i), payload(1));
  int full = 0;
  for (const ItemUpdate& update : missing(own, peer)) full += peer.take(update, kMost) == Holding::Taken::kFull ? 1 : 0;
  EXPECT_GT(full, 50);
  EXPECT_LE(peer.bytes(), kMost);
  EXPECT_FALSE(peer.known().complete(own.newest()));
  const auto held = peer.items().begin();
  EXPECT_EQ(peer.take({held->first, 1000, 0, held->second.payload}, kMost),
            Holding::Taken::kNew);  // what is held may change
}

/// A map that does not fit must not keep robots from hearing where it lies.
TEST(Holding, WhatIsNoTileIsTakenWhenTilesFillIt) {
  Holding own, peer;
  for (unsigned i = 0; i < 100; ++i) own.say(item(i), payload(1));
  own.say(ItemId::edge(3), payload(2));
  for (const ItemUpdate& update : missing(own, peer)) peer.take(update, 4000);
  EXPECT_TRUE(peer.items().contains(ItemId::edge(3)));
  for (unsigned i = 0; i < 60'000; ++i) own.say(ItemId::edge(static_cast<std::uint16_t>(i)), payload(2));
  for (const ItemUpdate& update : missing(own, peer)) peer.take(update, 4000);
  EXPECT_LE(peer.bytes(), 4000U + Holding::kForOthers);
}

TEST(Holding, TwoItemsOfOneVersionDoNoHarm) {
  Holding liar;
  const auto bytes = payload(3);
  liar.take({item(1), 5, 4, bytes}, kAll);
  liar.take({item(2), 5, 4, bytes}, kAll);
  liar.take({item(2), 6, 0, bytes}, kAll);
  liar.take({item(1), 7, 0, bytes}, kAll);
  EXPECT_EQ(missing(liar, Holding{}).size(), 2U);
}

}  // namespace
}  // namespace cairn::peers
