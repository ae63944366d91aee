// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/sample.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace cairn::matching {
namespace {

TEST(Sample, KeepsOrderAndTakesNoneTwice) {
  std::vector<int> items(1000);
  std::iota(items.begin(), items.end(), 0);
  const auto chosen = sample(std::span<const int>(items), 100);
  ASSERT_EQ(chosen.size(), 100U);
  for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_LT(chosen[i - 1], chosen[i]);
  EXPECT_LT(chosen.front(), 100);  // spread over all of it
  EXPECT_GT(chosen.back(), 900);
  EXPECT_EQ(chosen, sample(std::span<const int>(items), 100));
}

TEST(Sample, OfFewIsAll) {
  const std::vector<int> items{3, 1, 2};
  EXPECT_EQ(sample(std::span<const int>(items), 3), items);
  EXPECT_EQ(sample(std::span<const int>(items), 10), items);
  EXPECT_TRUE(sample(std::span<const int>(), 10).empty());
}

}  // namespace
}  // namespace cairn::matching
