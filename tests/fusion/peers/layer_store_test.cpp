// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/layer_store.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cairn::peers {
namespace {

constexpr RobotId kOwnId = 1;
constexpr std::size_t kMaxBytes = 1U << 20U;

class LayerStoreTest : public testing::Test {
 protected:
  /// Items of one tile each, with these versions.
  Items items(RobotId robot, Epoch epoch, const std::vector<Version>& versions) {
    Items items{.robot = robot, .epoch = epoch, .superseded = {}, .updates = {}};
    for (const Version version : versions)
      items.updates.push_back({.id = ItemId::tile(0, {version}), .version = version, .payload = payload_});
    return items;
  }
  [[nodiscard]] std::size_t held(RobotId robot) const { return store_.all().at(robot).holding.items().size(); }

  std::vector<std::byte> payload_{std::byte{0x84}};
  LayerStore store_{kOwnId, 5, {.robots = 2, .bytes = kMaxBytes, .spare_bytes = 0}};
};

TEST_F(LayerStoreTest, ItsOwnLayerIsThereFromTheBeginning) {
  EXPECT_EQ(store_.own().epoch, 5U);
  EXPECT_TRUE(store_.take_changes().at(kOwnId).anew);
  EXPECT_TRUE(store_.say(ItemId::tile(0, {8}), payload_));
  EXPECT_FALSE(store_.say(ItemId::tile(0, {8}), payload_)) << "no news";
  const Changes changes = store_.take_changes();
  EXPECT_FALSE(changes.at(kOwnId).anew);
  EXPECT_EQ(changes.at(kOwnId).items.size(), 1U);
  EXPECT_TRUE(store_.take_changes().empty());
}

TEST_F(LayerStoreTest, ABeginningVoidsWhatWasPublished) {
  store_.say(ItemId::tile(0, {8}), payload_);
  store_.begin(9);
  EXPECT_EQ(store_.own().epoch, 9U);
  EXPECT_EQ(held(kOwnId), 0U);
}

TEST_F(LayerStoreTest, OutdoingAnEpochPublishesEverythingAgain) {
  store_.say(ItemId::tile(0, {8}), payload_);
  store_.say(ItemId::tile(0, {9}), payload_);
  (void)store_.take_changes();
  store_.outdo(70);
  EXPECT_EQ(store_.own().epoch, 71U);
  EXPECT_EQ(held(kOwnId), 2U);
  const Changes changes = store_.take_changes();
  EXPECT_TRUE(changes.at(kOwnId).anew);
  EXPECT_EQ(changes.at(kOwnId).items.size(), 2U);
  store_.outdo(kLastEpoch);
  EXPECT_EQ(store_.own().epoch, kLastEpoch);
}

TEST_F(LayerStoreTest, TakesItemsOnceAndInAnyOrder) {
  const auto first = store_.take(items(2, 1, {3, 1}));
  EXPECT_TRUE(first.wanted);
  EXPECT_EQ(first.fresh, 2U);
  EXPECT_EQ(first.repeated, 0U);
  const auto second = store_.take(items(2, 1, {1, 2}));
  EXPECT_EQ(second.fresh, 1U);
  EXPECT_EQ(second.repeated, 1U);
  EXPECT_EQ(held(2), 3U);
  EXPECT_EQ(store_.take_changes().at(2).items.size(), 3U);
}

TEST_F(LayerStoreTest, ALaterEpochVoidsAnEarlierAndNotTheOtherWayRound) {
  (void)store_.take(items(2, 7, {1, 2}));
  EXPECT_FALSE(store_.take(items(2, 6, {3})).wanted);
  store_.hear_of(2, 6);
  EXPECT_EQ(held(2), 2U);
  (void)store_.take_changes();
  store_.hear_of(2, 8);
  EXPECT_EQ(held(2), 0U);
  EXPECT_TRUE(store_.take_changes().at(2).anew);
  store_.hear_of(3, 8);
  EXPECT_FALSE(store_.all().contains(3)) << "it has published nothing";
}

TEST_F(LayerStoreTest, MoreRobotsAreNotWanted) {
  EXPECT_TRUE(store_.take(items(2, 1, {1})).wanted);
  EXPECT_TRUE(store_.take(items(3, 1, {1})).wanted);
  EXPECT_FALSE(store_.take(items(4, 1, {1})).wanted);
  EXPECT_TRUE(store_.take(items(3, 1, {2})).wanted);
}

TEST_F(LayerStoreTest, MoreItemsThanAreKeptOfOneRobotAreNotTaken) {
  LayerStore small(kOwnId, 5, {.robots = 2, .bytes = 5000, .spare_bytes = 0});
  std::vector<Version> versions;
  for (Version version = 1; version <= 1000; ++version) versions.push_back(version);
  const auto taken = small.take(items(2, 1, versions));
  EXPECT_TRUE(taken.full);
  EXPECT_GT(taken.fresh, 0U);
  EXPECT_LT(taken.fresh, 1000U);
  EXPECT_EQ(small.all().at(2).holding.items().size(), taken.fresh);
}

/// What one robot does not need, another may take, and each has its own share in any case.
TEST_F(LayerStoreTest, WhatIsSpareIsSharedByThoseWhoNeedMore) {
  LayerStore store(kOwnId, 5, {.robots = 3, .bytes = 5000, .spare_bytes = 20'000});
  std::vector<Version> versions;
  for (Version version = 1; version <= 1000; ++version) versions.push_back(version);
  const auto bytes_of = [&](RobotId robot) { return store.all().at(robot).holding.bytes(); };
  EXPECT_TRUE(store.take(items(2, 1, versions)).full);
  EXPECT_GT(bytes_of(2), 23'000U);
  EXPECT_LE(bytes_of(2), 25'000U);
  EXPECT_TRUE(store.take(items(3, 1, versions)).full);
  EXPECT_GT(bytes_of(3), 4'000U) << "its share";
  EXPECT_LE(bytes_of(2) + bytes_of(3), 30'000U);
}

}  // namespace
}  // namespace cairn::peers
