// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_worth.hpp"

#include <gtest/gtest.h>

namespace cairn::team {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

const Time kBegin{seconds(1000)};

MatchOutlook outlook(std::size_t tiles, std::uint64_t version) {
  return {.own_tiles = tiles, .peer_tiles = tiles, .own_version = version, .peer_version = version};
}

/// Seconds after a comparison of `then`, at which one of `now` is worth its time; -1: not within a day.
int due_after(MatchWorth worth, const MatchOutlook& now) {
  for (int s = 0; s < 86400; ++s)
    if (worth.of(now, worth.last() + seconds(s)) > 0) return s;
  return -1;
}

MatchWorth compared(const MatchOutlook& then, Duration took = milliseconds(300), bool fruitful = false) {
  MatchWorth worth;
  worth.begin(then, kBegin);
  worth.end(fruitful, kBegin + took);
  return worth;
}

TEST(MatchWorth, TheFirstComparisonIsWorthItAtOnce) { EXPECT_GT(MatchWorth().of(outlook(60, 1), kBegin), 0); }

TEST(MatchWorth, MapsThatGrowAreComparedAfterAPause) {
  EXPECT_EQ(due_after(compared(outlook(100, 1)), outlook(120, 2)), 5);
  EXPECT_EQ(due_after(compared(outlook(100, 1), seconds(3)), outlook(120, 2)), 12) << "long ones leave others time";
}

TEST(MatchWorth, TheSameMapsAreNeverComparedAgain) {
  EXPECT_EQ(due_after(compared(outlook(100, 1)), outlook(100, 1)), -1);
}

TEST(MatchWorth, WithoutGrowthEachRetryInVainWaitsLonger) {
  MatchWorth worth = compared(outlook(100, 1));
  int last = 0;
  for (std::uint64_t version = 2; version < 12; ++version) {
    const int after = due_after(worth, outlook(101, version));
    EXPECT_GE(after, last);
    EXPECT_GE(after, 20);
    EXPECT_LE(after, 20 * 60);
    last = after;
    worth.begin(outlook(101, version), worth.last() + seconds(after));
    worth.end(false, worth.last() + milliseconds(300));
  }
  EXPECT_EQ(last, 20 * 60);
  worth.end(true, worth.last() + milliseconds(300));
  EXPECT_EQ(due_after(worth, outlook(101, 99)), 20) << "it moves again";
  EXPECT_EQ(due_after(worth, outlook(130, 99)), 5);
}

TEST(MatchWorth, WhereThePoseIsKnownWhatBothSeeCounts) {
  MatchOutlook then = outlook(100, 1);
  then.common_tiles = 40;
  MatchOutlook elsewhere = outlook(300, 2), there = outlook(300, 2);
  elsewhere.common_tiles = 41;
  there.common_tiles = 60;
  elsewhere.merged = there.merged = true;
  EXPECT_GE(due_after(compared(then), elsewhere), 20);
  EXPECT_EQ(due_after(compared(then), there), 5);
}

TEST(MatchWorth, MoreIsWorthMore) {
  const auto worth = [](const MatchOutlook& o, Duration took = milliseconds(500)) {
    return compared(outlook(10, 1), took).of(o, kBegin + minutes(30));
  };
  MatchOutlook none = outlook(100, 2), some = none, many = none, merged = none;
  none.common_tiles = 0;
  some.common_tiles = 20;
  many.common_tiles = merged.common_tiles = 50;
  merged.merged = true;
  EXPECT_GT(worth(none), 0) << "the pose may be wrong";
  EXPECT_LT(worth(none), worth(some));
  EXPECT_LT(worth(some), worth(many));
  EXPECT_LT(worth(merged), worth(many));
  EXPECT_LT(worth(many, seconds(5)), worth(many));
}

}  // namespace
}  // namespace cairn::team
