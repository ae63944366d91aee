// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/team_consistency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/fusion/matching/planar_pose.hpp"

namespace cairn::matching {
namespace {

/// Robots of a team, where they truly are.
const std::vector<SE3> kTruePoses{planar_pose(0, 0, 0), planar_pose(10, 3, 0.5), planar_pose(-4, 8, 2),
                                  planar_pose(6, -9, -1.2)};

Claim claim(int a, int b, double probability, const SE3& off = {}) {
  const auto of = [](int i) { return kTruePoses[static_cast<std::size_t>(i)]; };
  return {
      .a = a, .b = b, .T_a_b = {of(a).inverse() * of(b) * off, 1e-4 * Matrix6::Identity()}, .probability = probability};
}

TEST(TeamConsistency, ClaimsThatCloseAreKept) {
  const std::vector<Claim> claims{claim(0, 1, 0.99), claim(1, 2, 0.97), claim(2, 0, 0.96)};
  const Agreement a = agreement_of(claims);
  EXPECT_EQ(a.kept, std::vector<bool>(3, true));
  for (const int loops : a.closed) EXPECT_EQ(loops, 1);
}

TEST(TeamConsistency, AWrongOneIsOutvotedThoughItSeemsSurest) {
  const SE3 wrong = planar_pose(5, 0, 3.1);
  const std::vector<Claim> claims{claim(0, 1, 0.999, wrong), claim(0, 2, 0.9), claim(1, 2, 0.9),
                                  claim(0, 3, 0.9),          claim(1, 3, 0.9), claim(2, 3, 0.9)};
  EXPECT_EQ(agreement_of(claims).kept, (std::vector<bool>{false, true, true, true, true, true}));
}

TEST(TeamConsistency, OfTwoClaimsAboutOnePairTheOneThatClosesALoopIsKept) {
  const std::vector<Claim> claims{claim(0, 1, 0.97, planar_pose(7, 7, 1)), claim(0, 1, 0.93), claim(1, 2, 0.95),
                                  claim(0, 2, 0.95)};
  EXPECT_EQ(agreement_of(claims).kept, (std::vector<bool>{false, true, true, true}));
}

TEST(TeamConsistency, WithoutALoopTheLikelierOfAPairIsKeptAndWhatIsUnlikelyIsNot) {
  const std::vector<Claim> claims{claim(0, 1, 0.8, planar_pose(1, 0, 0)), claim(0, 1, 0.9), claim(1, 2, 0.3)};
  EXPECT_EQ(agreement_of(claims).kept, (std::vector<bool>{false, true, false}));
}

TEST(TeamConsistency, LoopsMayBeLong) {
  std::vector<Claim> claims{claim(0, 1, 0.9), claim(1, 2, 0.9), claim(2, 3, 0.9),
                            claim(0, 3, 0.95, planar_pose(2, 0, 0))};
  const Agreement broken = agreement_of(claims);
  EXPECT_EQ(std::count(broken.kept.begin(), broken.kept.end(), true), 3);
  claims.back() = claim(0, 3, 0.95, planar_pose(0.1, -0.1, 0.01));  // maps bend that much
  const Agreement closed = agreement_of(claims);
  EXPECT_EQ(std::count(closed.kept.begin(), closed.kept.end(), true), 4);
  EXPECT_EQ(closed.closed, std::vector<int>(4, 1));
}

TEST(TeamConsistency, OrderAndDirectionDoNotMatter) {
  std::vector<Claim> claims{claim(0, 1, 0.99, planar_pose(3, 0, 0)),
                            claim(0, 2, 0.91),
                            claim(1, 2, 0.92),
                            claim(0, 1, 0.93),
                            claim(2, 3, 0.6),
                            claim(1, 3, 0.55, planar_pose(0, 4, 0))};
  const auto kept = agreement_of(claims).kept;
  std::vector<std::size_t> order(claims.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Claim> shuffled;
    for (const std::size_t i : order) {
      Claim c = claims[i];
      if (random() % 2 == 0) c = {c.b, c.a, inverse(c.T_a_b), c.probability};
      shuffled.push_back(c);
    }
    const auto again = agreement_of(shuffled).kept;
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(again[i], kept[order[i]]);
  }
}

TEST(TeamConsistency, NothingAndTooMuchAreFine) {
  EXPECT_TRUE(agreement_of({}).kept.empty());
  std::vector<Claim> many;
  for (int i = 0; i < 60; ++i) many.push_back(claim(i % 4, (i + 1) % 4, 0.5 + 0.008 * i, planar_pose(i, 0, 0)));
  many.push_back({2, 2, {}, 0.999});  // a robot about itself
  const auto kept = agreement_of(many).kept;
  EXPECT_LE(std::count(kept.begin(), kept.end(), true), static_cast<std::ptrdiff_t>(kMostClaims));
  EXPECT_FALSE(kept.back());
}

}  // namespace
}  // namespace cairn::matching
