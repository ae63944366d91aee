// SPDX-License-Identifier: Apache-2.0
// The oracle is a std::set of numbers.
#include "fusion/peers/items/version_set.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace cairn::peers {
namespace {

TEST(VersionSet, HoldsWhatASetOfNumbersHolds) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    VersionSet set;
    std::set<Version> oracle;
    for (int i = 0; i < 30; ++i) {
      const Version first = 1 + random() % 120, last = first + random() % 8;
      set.add({first, last});
      for (Version v = first; v <= last; ++v) oracle.insert(v);
      for (Version v = 1; v < 140; ++v) ASSERT_EQ(set.contains(v), oracle.contains(v));
    }
    for (std::size_t i = 1; i < set.ranges().size(); ++i)
      ASSERT_GT(set.ranges()[i].first, set.ranges()[i - 1].last + 1);
  }
}

TEST(VersionSet, KnowsWhereARunBegins) {
  VersionSet set;
  set.add({3, 5});
  set.add({6, 9});
  set.add({20, 20});
  EXPECT_EQ(set.start_of_run(8), 3U);
  EXPECT_EQ(set.start_of_run(20), 20U);
  EXPECT_FALSE(set.complete(5));
  set.add({0, 2});
  EXPECT_TRUE(set.complete(9));
  EXPECT_FALSE(set.complete(10));
}

TEST(VersionSet, NothingIsAddedByAnEmptyRange) {
  VersionSet set;
  set.add({0, 0});
  set.add({7, 6});
  EXPECT_TRUE(set.ranges().empty());
  EXPECT_TRUE(set.complete(0));
}

TEST(VersionSet, TheLargestNumbersDoNotOverflow) {
  VersionSet set;
  const Version most = ~Version{0};
  set.add({most - 1, most});
  set.add({most, most});
  EXPECT_EQ(set.ranges().size(), 1U);
  EXPECT_TRUE(set.contains(most));
}

TEST(VersionSet, ForgetsTheHighestWhenTheRangesAreTooMany) {
  VersionSet set;
  for (Version v = 1000; v > 0; v -= 2) set.add({v, v});
  EXPECT_EQ(set.ranges().size(), VersionSet::kMostRanges);
  EXPECT_TRUE(set.contains(2));
  EXPECT_FALSE(set.contains(1000));
}

}  // namespace
}  // namespace cairn::peers
