// SPDX-License-Identifier: Apache-2.0
// What one robot does with what it hears; that fleets agree is in tests/fusion/fleet.
#include "fusion/peers/exchange.hpp"

#include <gtest/gtest.h>

#include "fusion/peers/tile_codec.hpp"
#include "tests/fusion/peers/tile_states.hpp"

namespace cairn::peers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::vector<std::byte> tile(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::byte> payload;
  encode_tile(wall_tile_state(random), payload);
  return payload;
}

/// Some seconds in which nothing is lost.
void talk(Exchange& a, Exchange& b, Time& now, Duration length) {
  for (const Time end = now + length; now < end; now += milliseconds(100)) {
    std::vector<Outgoing> out;
    a.send(now, out);
    for (const Outgoing& datagram : out) EXPECT_TRUE(b.receive(datagram.bytes, now).has_value());
    out.clear();
    b.send(now, out);
    for (const Outgoing& datagram : out) EXPECT_TRUE(a.receive(datagram.bytes, now).has_value());
  }
}

TEST(Exchange, WhatOneSaysTheOtherKnowsAndHearsOfOnce) {
  Exchange a(1, "one", 5), b(2, "two", 6);
  Time now{};
  for (unsigned i = 0; i < 20; ++i) EXPECT_TRUE(a.say(ItemId::tile(0, {i}), tile(i)));
  talk(a, b, now, seconds(5));
  const auto changes = b.take_changes();
  EXPECT_TRUE(changes.at(1).anew);
  EXPECT_EQ(changes.at(1).items.size(), 20U);
  EXPECT_TRUE(b.take_changes().empty());
  EXPECT_FALSE(a.say(ItemId::tile(0, {3}), tile(3)));  // nothing new
  EXPECT_TRUE(a.say(ItemId::tile(0, {3}), tile(99)));
  talk(a, b, now, seconds(3));
  EXPECT_EQ(b.take_changes().at(1).items.size(), 1U);
  EXPECT_EQ(b.links().at(1).name, "one");
  EXPECT_EQ(b.links().at(1).repeated_items, 0U);
}

TEST(Exchange, ANewEpochVoidsWhatWasSaid) {
  Exchange a(1, "one", 5), b(2, "two", 6);
  Time now{};
  a.say(ItemId::tile(0, {1}), tile(1));
  talk(a, b, now, seconds(3));
  (void)b.take_changes();
  a.begin(8);
  talk(a, b, now, seconds(3));
  EXPECT_TRUE(b.take_changes().at(1).anew);
  EXPECT_TRUE(b.layers().at(1).holding.items().empty());
  EXPECT_EQ(b.layers().at(1).epoch, 8U);
}

TEST(Exchange, NeverSendsMoreThanItMayInALongTime) {
  ExchangeConfig config;
  config.bytes_per_second = 4000;
  Exchange a(1, "one", 5, config), b(2, "two", 6, config);
  std::size_t sent = 0;
  Time now{};
  for (unsigned step = 0; step < 600; ++step, now += milliseconds(100)) {
    for (unsigned i = 0; i < 10; ++i) a.say(ItemId::tile(0, {step % 50 * 10 + i}), tile(step * 10 + i));
    std::vector<Outgoing> out;
    a.send(now, out);
    for (const Outgoing& datagram : out) {
      sent += datagram.bytes.size() + config.overhead_bytes;
      (void)b.receive(datagram.bytes, now);
    }
    out.clear();
    b.send(now, out);
    for (const Outgoing& datagram : out) (void)a.receive(datagram.bytes, now);
  }
  EXPECT_LE(sent, 61U * 4000);
  EXPECT_GE(sent, 50U * 4000);
}

TEST(Exchange, TheMostUrgentGoesFirst) {
  Exchange a(1, "one", 5), b(2, "two", 6);
  a.set_urgency([](RobotId, RobotId, const ItemUpdate& update) { return update.id.tile().morton == 400 ? 0.0 : 1.0; });
  Time now{};
  talk(a, b, now, seconds(2));
  for (unsigned i = 0; i < 500; ++i) a.say(ItemId::tile(0, {i}), tile(i));
  while (!b.layers().contains(1)) talk(a, b, now, milliseconds(100));
  EXPECT_TRUE(b.layers().at(1).holding.items().contains(ItemId::tile(0, {400})));
  EXPECT_LT(b.layers().at(1).holding.items().size(), 400U);
}

TEST(Exchange, WhoSendsTooMuchThatCannotBeIsNotListenedTo) {
  Exchange b(2, "two", 6);
  Time now{};
  auto bad = encode(1, Hello{5, 0, Time{}, "one", {}});
  bad.back() = std::byte{200};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(b.receive(bad, now += seconds(1)).error().code, Errc::kMalformed);
  const auto good = encode(1, Hello{5, 0, now.time_since_epoch() + Time{}, "one", {}});
  EXPECT_EQ(b.receive(good, now + seconds(1)).error().code, Errc::kLinkDown);
  EXPECT_TRUE(b.receive(good, now + seconds(62)).has_value());
}

TEST(Exchange, ListensToSoManyRobotsAndNoMore) {
  ExchangeConfig config;
  config.max_robots = 3;
  Exchange b(100, "hundred", 6, config);
  for (RobotId id = 1; id <= 3; ++id)
    EXPECT_TRUE(b.receive(encode(id, Hello{5, 0, Time{}, "x", {}}), Time{}).has_value());
  EXPECT_EQ(b.receive(encode(4, Hello{5, 0, Time{}, "x", {}}), Time{}).error().code, Errc::kLimit);
  EXPECT_EQ(b.receive(encode(100, Hello{5, 0, Time{}, "x", {}}), Time{}).error().cause,
            "another robot has this robot's id");
}

}  // namespace
}  // namespace cairn::peers
