// SPDX-License-Identifier: Apache-2.0
// What one robot does with what it hears; that fleets agree is in tests/fusion/fleet.
#include "fusion/peers/exchange.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "fusion/peers/items/tile_codec.hpp"
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

Bodies one_person(double x) {
  Bodies bodies;
  bodies.people.push_back({.id = 1, .position_m = {x, 0, 0}});
  return bodies;
}

TEST(Exchange, TellsWherePeopleAreOnceAndOnlyTheNewest) {
  Exchange a(1, "one", 5), b(2, "two", 6);
  Time now{};
  talk(a, b, now, seconds(2));
  const std::uint64_t before = a.links().at(2).sent_bodies_bytes;
  a.set_bodies(one_person(3), now);
  talk(a, b, now, milliseconds(500));
  ASSERT_TRUE(b.links().at(1).bodies);
  EXPECT_EQ(b.links().at(1).bodies->bodies.epoch, 5U);
  EXPECT_EQ(b.links().at(1).bodies->bodies.people[0].position_m.x(), 3);
  const std::uint64_t once = a.links().at(2).sent_bodies_bytes - before;
  talk(a, b, now, seconds(2));
  EXPECT_EQ(a.links().at(2).sent_bodies_bytes - before, once) << "nothing is sent twice";
  EXPECT_LT(once, 200U);
}

TEST(Exchange, WhatIsOldOrLateIsNotTold) {
  Exchange a(1, "one", 5), b(2, "two", 6);
  Time now{seconds(100)};
  talk(a, b, now, seconds(2));
  a.set_bodies(one_person(1), now - Bodies::kLife - milliseconds(1));
  talk(a, b, now, milliseconds(300));
  EXPECT_FALSE(b.links().at(1).bodies);
  Link link;
  Bodies newer = one_person(2), late = one_person(1);
  newer.stamp = now;
  newer.age = milliseconds(200);
  late.stamp = now - milliseconds(1);
  link.take(newer, now);
  link.take(late, now);
  EXPECT_EQ(link.bodies->bodies.people[0].position_m.x(), 2);
  EXPECT_EQ(link.bodies->seen, now - milliseconds(200));
}

/// Ten minutes with eight people, to three peers.
TEST(Exchange, PeopleOfAMissionTakeLessThanAMegabyte) {
  Exchange a(1, "one", 5);
  std::vector<Exchange> peers;
  for (RobotId id = 2; id <= 4; ++id) peers.emplace_back(id, "peer", 6);
  Bodies bodies;
  for (std::uint32_t id = 1; id <= 8; ++id) bodies.people.push_back({.id = id, .position_m = {12.34, -5.67, 0.02}});
  Time now{};
  for (int step = 0; step < 6000; ++step, now += milliseconds(100)) {
    if (step % 5 == 0) a.set_bodies(bodies, now);
    std::vector<Outgoing> out;
    a.send(now, out);
    if (step % 10 != 0) continue;
    for (Exchange& peer : peers) {
      out.clear();
      peer.send(now, out);
      for (const Outgoing& datagram : out) EXPECT_TRUE(a.receive(datagram.bytes, now));
    }
  }
  std::uint64_t bytes = 0;
  for (const auto& [robot, link] : a.links()) bytes += link.sent_bodies_bytes;
  std::cout << "human states: " << bytes << " bytes\n";
  EXPECT_GT(bytes, 3 * 1000 * 150U);
  EXPECT_LT(bytes, 1'000'000U);
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

mapping::TileKey tile_in_row(unsigned i) {
  return mapping::TileKey::of_voxel(static_cast<std::uint16_t>(32768 + 8 * (i % 100)),
                                    static_cast<std::uint16_t>(32768 + 8 * (i / 100)), 32768);
}

/// One has mapped a hall of 100 × 40 tiles, row by row; the other joins somewhere over 64 kbit/s. Seconds until it
/// knows the tiles around itself, and until it knows all.
std::pair<double, double> join(bool with_interest) {
  ExchangeConfig config;
  config.bytes_per_second = 8000;
  Exchange a(1, "one", 5, config), b(2, "two", 6, config);
  constexpr unsigned kTiles = 4000, kAtX = 70, kAtY = 30;
  const auto at = [](unsigned tiles) { return 1.6 * (tiles + 0.5); };
  b.set_place({{at(kAtX), at(kAtY), 0.5}, 0, 0.1, 0.01});
  if (with_interest)
    a.set_interest([&](RobotId peer, RobotId) {
      Interest interest;
      if (const auto& place = a.links().at(peer).place)
        interest.position_odom = Eigen::Map<const Eigen::Vector3d>(place->position_m.data());
      return interest;
    });
  for (unsigned i = 0; i < kTiles; ++i) a.say(ItemId::tile(0, tile_in_row(i)), tile(i));
  const auto knows = [&](unsigned x, unsigned y) {
    const auto layer = b.layers().find(1);
    return layer != b.layers().end() &&
           layer->second.holding.items().contains(ItemId::tile(0, tile_in_row(100 * y + x)));
  };
  std::pair<double, double> after{-1, -1};
  for (Time now{}; now < Time{std::chrono::minutes(5)} && after.second < 0;) {
    talk(a, b, now, milliseconds(100));
    bool around = true;
    for (unsigned y = kAtY - 3; y <= kAtY + 3; ++y)
      for (unsigned x = kAtX - 3; x <= kAtX + 3; ++x) around = around && knows(x, y);
    if (around && after.first < 0) after.first = to_seconds(now - Time{});
    if (b.layers().contains(1) && b.layers().at(1).holding.items().size() == kTiles)
      after.second = to_seconds(now - Time{});
  }
  return after;
}

TEST(Exchange, WhoJoinsGetsWhatIsAroundItFirst) {
  const auto [around_by_age, all_by_age] = join(false);
  const auto [around, all] = join(true);
  std::cout << "tiles around a robot that joins after " << around << " s, all after " << all << " s; oldest first "
            << around_by_age << " s and " << all_by_age << " s\n";
  EXPECT_GT(around, 0);
  EXPECT_LT(around, 0.2 * around_by_age);
  EXPECT_LT(all, 1.1 * all_by_age);
}

TEST(Exchange, WhoSendsTooMuchThatCannotBeIsNotListenedTo) {
  Exchange b(2, "two", 6);
  Time now{};
  auto bad = encode({1, Hello{5, 0, Time{}, "one", {}}, {}, {}}).bytes;
  bad.back() = std::byte{200};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(b.receive(bad, now += seconds(1)).error().code, Errc::kMalformed);
  const auto good = encode({1, Hello{5, 0, now.time_since_epoch() + Time{}, "one", {}}, {}, {}}).bytes;
  EXPECT_EQ(b.receive(good, now + seconds(1)).error().code, Errc::kLinkDown);
  EXPECT_TRUE(b.receive(good, now + seconds(62)).has_value());
}

TEST(Exchange, ListensToSoManyRobotsAndNoMore) {
  ExchangeConfig config;
  config.max_robots = 3;
  Exchange b(100, "hundred", 6, config);
  for (RobotId id = 1; id <= 3; ++id)
    EXPECT_TRUE(b.receive(encode({id, Hello{5, 0, Time{}, "x", {}}, {}, {}}).bytes, Time{}).has_value());
  EXPECT_EQ(b.receive(encode({4, Hello{5, 0, Time{}, "x", {}}, {}, {}}).bytes, Time{}).error().code, Errc::kLimit);
  EXPECT_EQ(b.receive(encode({100, Hello{5, 0, Time{}, "x", {}}, {}, {}}).bytes, Time{}).error().cause,
            "another robot has this robot's id");
}

}  // namespace
}  // namespace cairn::peers
