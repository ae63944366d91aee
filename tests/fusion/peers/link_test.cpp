// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/link.hpp"

#include <gtest/gtest.h>

namespace cairn::peers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr RobotId kSelf = 1;

Hello hello(Epoch epoch, Time stamp) { return {.epoch = epoch, .newest = 4, .stamp = stamp, .name = "two"}; }

VersionSet versions(Version first, Version last) {
  VersionSet set;
  set.add({first, last});
  return set;
}

TEST(Link, TakesTheNewestHello) {
  Link link;
  EXPECT_TRUE(link.take(hello(5, Time{seconds(10)}), kSelf, Time{seconds(1)}));
  EXPECT_EQ(link.epoch, 5U);
  EXPECT_EQ(link.newest, 4U);
  EXPECT_EQ(link.name, "two");
  EXPECT_FALSE(link.take(hello(5, Time{seconds(10)}), kSelf, Time{seconds(2)})) << "the same again";
  EXPECT_FALSE(link.take(hello(5, Time{seconds(9)}), kSelf, Time{seconds(2)})) << "an earlier one";
  EXPECT_FALSE(link.take(hello(4, Time{seconds(99)}), kSelf, Time{seconds(2)})) << "of an earlier beginning";
  EXPECT_EQ(link.echo_heard, Time{seconds(1)});
}

TEST(Link, APeerThatBeginsAnewMayKnowNothing) {
  Link link;
  (void)link.take(hello(5, Time{seconds(10)}), kSelf, Time{});
  link.take(Digest{.layers = {{.robot = 1, .epoch = 3, .direct = true, .known = versions(1, 9)}}});
  EXPECT_TRUE(link.told);
  (void)link.take(hello(5, Time{seconds(11)}), kSelf, Time{});
  EXPECT_EQ(link.known.at(1).versions, versions(1, 9));
  (void)link.take(hello(6, Time{seconds(1)}), kSelf, Time{});
  EXPECT_FALSE(link.told);
  EXPECT_TRUE(link.known.empty());
}

TEST(Link, AnEchoOfOnesOwnHelloTellsTheClock) {
  Link link;
  Hello reply = hello(5, Time{seconds(1000)});
  reply.echo = Hello::Echo{.robot = 3, .stamp = Time{}, .age = {}};
  (void)link.take(reply, kSelf, Time{milliseconds(100)});
  EXPECT_FALSE(link.clock.estimate()) << "another robot's";
  reply.stamp += seconds(1);
  reply.echo->robot = kSelf;
  (void)link.take(reply, kSelf, Time{milliseconds(100)});
  ASSERT_TRUE(link.clock.estimate());
  EXPECT_EQ(link.round_trip({}), milliseconds(100) + ExchangeConfig{}.answer);
}

TEST(Link, ADigestOfTooManyRobotsIsCut) {
  Link link;
  for (RobotId robot = 1; robot < 100; ++robot)
    link.take(Digest{.layers = {{.robot = robot, .epoch = 1, .direct = false, .known = {}}}});
  EXPECT_EQ(link.known.size(), Digest::kMaxLayers);
}

TEST(Link, ItemsInFlightArriveOrAreLost) {
  Link link;
  for (Version version = 1; version <= 3; ++version) link.in_flight[{7, version}] = Time{seconds(version)};
  link.in_flight[{8, 1}] = Time{};
  const Digest digest{.layers = {{.robot = 7, .epoch = 1, .direct = true, .known = versions(1, 1)}}};
  link.settle_in_flight(digest, seconds(2), Time{milliseconds(4500)});
  EXPECT_FALSE(link.in_flight.contains({7, 1})) << "it arrived";
  EXPECT_FALSE(link.in_flight.contains({7, 2})) << "it is lost";
  EXPECT_TRUE(link.in_flight.contains({7, 3})) << "the digest may be older";
  EXPECT_TRUE(link.in_flight.contains({8, 1})) << "the digest does not tell of robot 8";
  EXPECT_GT(link.loss, 0);
}

TEST(Link, WhatIsGivenUpCountsAsLostOrNot) {
  Link link;
  for (const bool lost : {false, true}) {
    link.in_flight[{7, 1}] = Time{};
    link.in_flight[{7, 2}] = Time{seconds(3)};
    link.give_up(seconds(2), lost, Time{seconds(4)});
    EXPECT_EQ(link.in_flight.size(), 1U);
    EXPECT_EQ(link.loss > 0, lost);
  }
}

TEST(Link, LossIsAShareOfTheLastItems) {
  Link link;
  for (Version version = 1; version <= 1000; ++version) {
    link.in_flight[{7, version}] = Time{};
    const VersionSet arrived = version % 4 == 0 ? VersionSet{} : versions(version, version);
    link.settle_in_flight({.layers = {{.robot = 7, .epoch = 1, .direct = true, .known = arrived}}}, seconds(1),
                          Time{seconds(5)});
  }
  EXPECT_NEAR(link.loss, 0.25, 0.02);
}

TEST(Link, WithoutAClockARoundTripTakesTheLongestWay) {
  EXPECT_EQ(Link().round_trip({}), ExchangeConfig{}.longest_way + ExchangeConfig{}.answer);
}

}  // namespace
}  // namespace cairn::peers
