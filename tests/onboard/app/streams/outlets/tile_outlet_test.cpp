// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/outlets/tile_outlet.hpp"

#include <gmock/gmock.h>

namespace cairn::app {
namespace {

using ::testing::ElementsAre;

constexpr std::array kThree{mapping::TileKey{3}, mapping::TileKey{1}, mapping::TileKey{2}};

void read_nothing(TileNews& /*news*/) {}

std::vector<std::uint64_t> taken(TileOutlet& outlet) {
  std::vector<std::uint64_t> keys;
  for (; const TileNews* news = outlet.tiles().front(); outlet.tiles().pop()) keys.push_back(news->tile.morton);
  return keys;
}

TEST(TileOutlet, WhatFindsNoRoomGoesLater) {
  TileOutlet outlet(2);
  outlet.begin(0);
  outlet.owe(kThree);
  outlet.hand_over(9, read_nothing);
  EXPECT_EQ(outlet.owed(), 1U);
  EXPECT_THAT(taken(outlet), ElementsAre(1, 2));
  outlet.owe(kThree);  // again changed
  outlet.hand_over(1, read_nothing);
  EXPECT_THAT(taken(outlet), ElementsAre(1));
  outlet.hand_over(9, read_nothing);
  EXPECT_THAT(taken(outlet), ElementsAre(2, 3));
}

TEST(TileOutlet, TheConsumerKnowsWhetherThereIsMore) {
  TileOutlet outlet(2);
  EXPECT_TRUE(outlet.settled());
  outlet.begin(0);
  outlet.owe(kThree);
  EXPECT_FALSE(outlet.settled());
  outlet.hand_over(9, read_nothing);
  EXPECT_EQ(taken(outlet).size(), 2U);
  EXPECT_FALSE(outlet.settled());
  outlet.hand_over(9, read_nothing);
  EXPECT_FALSE(outlet.settled());
  EXPECT_EQ(taken(outlet).size(), 1U);
  EXPECT_TRUE(outlet.settled());
}

TEST(TileOutlet, ATileIsReadWhenItGoes) {
  TileOutlet outlet;
  outlet.begin(7);
  outlet.owe(std::span(kThree).first(1));
  outlet.hand_over(9,
                   [](TileNews& news) { news.changed = Time{Duration{static_cast<std::int64_t>(news.tile.morton)}}; });
  const TileNews* news = outlet.tiles().front();
  ASSERT_NE(news, nullptr);
  EXPECT_EQ(news->epoch, 7U);
  EXPECT_EQ(news->changed, Time{Duration{3}});
}

TEST(TileOutlet, AResumedMapWaitsUntilItIsKnownThatItGoesOn) {
  TileOutlet goes_on, anew;
  for (TileOutlet* outlet : {&goes_on, &anew}) {
    outlet->owe(kThree);
    outlet->hand_over(9, read_nothing);
    EXPECT_EQ(outlet->owed(), 3U);
  }
  goes_on.begin(0);
  goes_on.hand_over(9, read_nothing);
  EXPECT_EQ(taken(goes_on).size(), 3U);
  anew.begin(1);
  EXPECT_EQ(anew.owed(), 0U);
}

}  // namespace
}  // namespace cairn::app
