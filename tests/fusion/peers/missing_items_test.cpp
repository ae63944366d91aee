// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/missing_items.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cairn::peers {
namespace {

constexpr RobotId kSender = 1, kPeer = 2, kThird = 3;

mapping::TileKey tile_number(unsigned x) {
  return mapping::TileKey::of_voxel(static_cast<std::uint16_t>(32768 + 8 * x), 32768, 32768);
}

class MissingItems : public testing::Test {
 protected:
  /// So many tiles in a row, all occupied.
  void publish(unsigned tiles) {
    for (unsigned x = 0; x < tiles; ++x) layer_.holding.say(ItemId::tile(0, tile_number(x)), payload_);
  }
  [[nodiscard]] std::vector<Version> missing(RobotId robot = kSender, const InterestOf& interest_of = {}) const {
    std::vector<Version> versions;
    const Delivery delivery{.peer = kPeer, .robot = robot, .layer = layer_};
    for (const ItemUpdate& update : missing_items(delivery, link_, kSender, interest_of).updates)
      versions.push_back(update.version);
    return versions;
  }
  void knows(RobotId robot, Epoch epoch, bool direct, Version last) {
    Link::Known& known = link_.known[robot] = {.epoch = epoch, .direct = direct, .versions = {}};
    if (last > 0) known.versions.add({1, last});
  }

  std::vector<std::byte> payload_{std::byte{0x84}};  // a uniform tile, occupied
  Layer layer_{.epoch = 5, .holding = Holding()};
  Link link_;
};

TEST_F(MissingItems, AreThoseThatThePeerDoesNotKnow) {
  publish(5);
  EXPECT_EQ(missing(), (std::vector<Version>{1, 2, 3, 4, 5}));
  knows(kSender, 5, true, 3);
  EXPECT_EQ(missing(), (std::vector<Version>{4, 5}));
  link_.in_flight[{kSender, 4}] = Time{};
  EXPECT_EQ(missing(), std::vector<Version>{5}) << "4 is under way";
}

TEST_F(MissingItems, APeerThatKnowsAnEarlierEpochLacksAll) {
  publish(3);
  knows(kSender, 4, true, 3);
  EXPECT_EQ(missing().size(), 3U);
  knows(kSender, 6, true, 0);
  EXPECT_TRUE(missing().empty()) << "a later one: this robot's own is void";
}

TEST_F(MissingItems, OfAThirdRobotNothingIsSentToAPeerThatHearsIt) {
  publish(3);
  knows(kThird, 5, false, 1);
  EXPECT_EQ(missing(kThird).size(), 2U);
  knows(kThird, 5, true, 1);
  EXPECT_TRUE(missing(kThird).empty());
}

TEST_F(MissingItems, WhatIsNearThePeerComesFirstAlsoIfItIsNewer) {
  publish(2 * kLookedAt);
  const double last_x = 1.6 * (2 * kLookedAt - 0.5);  // the last tile's middle
  const auto versions = missing(kSender, [&](RobotId peer, RobotId robot) {
    EXPECT_EQ(peer, kPeer);
    EXPECT_EQ(robot, kSender);
    return Interest{.position_odom = Eigen::Vector3d(last_x, 0.8, 0.8)};
  });
  ASSERT_GT(versions.size(), kLookedAt);
  EXPECT_GT(versions[0], 2 * kLookedAt - 4) << "of those in the nearest ring, the oldest";
  EXPECT_EQ(missing()[0], 1U) << "without an interest, the oldest is first";
}

TEST_F(MissingItems, WhereOneRobotLiesInAnotherComesFirstHoweverManyTilesAreMissing) {
  publish(2 * kLookedAt);
  ASSERT_TRUE(layer_.holding.say(ItemId::edge(0), payload_));
  ASSERT_TRUE(layer_.holding.say(ItemId::deployment(), payload_));
  const auto versions = missing(kSender, [](RobotId, RobotId) { return Interest{}; });
  ASSERT_GT(versions.size(), kLookedAt);
  EXPECT_EQ(versions[0], 2 * kLookedAt + 1);
  EXPECT_EQ(versions[1], 2 * kLookedAt + 2);
  EXPECT_EQ(versions[2], 1U);
  EXPECT_EQ(layer_.holding.without_tiles(), (std::vector<ItemId>{ItemId::edge(0), ItemId::deployment()}));
}

}  // namespace
}  // namespace cairn::peers
