// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/random.hpp"

#include <gtest/gtest.h>

#include <set>

namespace cairn::simulator {
namespace {

TEST(Random, FollowsFromSeedStreamAndIndexAlone) {
  Random a(7, 3, 99), b(7, 3, 99);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.next(), b.next());
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (std::uint64_t stream = 0; stream < 10; ++stream) {
      for (std::uint64_t index = 0; index < 10; ++index) first.insert(Random(seed, stream, index).next());
    }
  }
  EXPECT_EQ(first.size(), 1000u);
}

TEST(Random, IsTheSameOnEveryMachine) {
  // SplitMix64's published first output for state 0.
  EXPECT_EQ(mix(0), 0xe220a8397b1dcdafu);
}

TEST(Random, UniformHasTheRightMoments) {
  Random random(1);
  double sum = 0, squares = 0;
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.003);
  EXPECT_NEAR(squares / kDraws, 1.0 / 3.0, 0.003);
}

TEST(Random, NormalHasTheRightMomentsAndTails) {
  double sum = 0, squares = 0, products = 0;
  int outside = 0;
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const auto [a, b] = Random(1, 2, static_cast<std::uint64_t>(i)).normal_pair();
    sum += a + b;
    squares += a * a + b * b;
    products += a * b;
    outside += (std::abs(a) > 2.0) + (std::abs(b) > 2.0);
  }
  EXPECT_NEAR(sum / (2 * kDraws), 0.0, 0.01);
  EXPECT_NEAR(squares / (2 * kDraws), 1.0, 0.01);
  EXPECT_NEAR(products / kDraws, 0.0, 0.01);
  EXPECT_NEAR(outside / (2.0 * kDraws), 0.0455, 0.002);
}

TEST(Random, BelowStaysBelow) {
  Random random(3);
  std::set<std::size_t> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(random.below(7));
  EXPECT_EQ(seen.size(), 7u);
  EXPECT_EQ(*seen.rbegin(), 6u);
}

}  // namespace
}  // namespace cairn::simulator
