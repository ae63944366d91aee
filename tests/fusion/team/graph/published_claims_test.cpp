// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/published_claims.hpp"

#include <gtest/gtest.h>

#include "fusion/peers/own_submaps.hpp"
#include "fusion/team/graph/indexed_edge.hpp"
#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

peers::Edge edge_to(peers::RobotId other, double x) {
  return {.own_submap = 1,
          .other = other,
          .other_epoch = KnownTeam::kEpoch,
          .other_submap = 2,
          .T_own_other = KnownTeam::pose(KnownTeam::at(x, 0), 0.1, 0.01),
          .probability = 0.9F};
}

class PublishedClaims : public testing::Test {
 protected:
  PublishedClaims() { publish(2, 0, edge_to(1, 0)); }
  void publish(peers::RobotId robot, std::uint16_t index, const peers::Edge& edge) {
    team_.publish(robot, peers::ItemId::edge(index), encode(edge));
  }
  [[nodiscard]] std::vector<PairClaim> claims() const { return published_claims(team_.exchange.layers()); }

  KnownTeam team_;
};

TEST_F(PublishedClaims, AreThoseOfAllRobots) {
  publish(1, 0, edge_to(2, 5));
  publish(1, edge_index(EdgeOrigin::kRefined, 3), edge_to(2, 6));
  const auto claims = this->claims();
  ASSERT_EQ(claims.size(), 3U);
  EXPECT_EQ(claims[0].a, 1U);
  EXPECT_EQ(claims[0].b, 2U);
  EXPECT_EQ(claims[0].submap_a, 1);
  EXPECT_EQ(claims[0].submap_b, 2);
  EXPECT_EQ(claims[0].T_a_b.mean.translation().x(), 5);
  EXPECT_FLOAT_EQ(static_cast<float>(claims[0].probability), 0.9F);
  EXPECT_FALSE(claims[0].refined);
  EXPECT_TRUE(claims[1].refined);
  EXPECT_EQ(claims[2].a, 2U);
}

TEST_F(PublishedClaims, WhatDoesNotHoldIsLeftOut) {
  peers::Edge withdrawn = edge_to(2, 1), earlier = edge_to(2, 1), sure = edge_to(2, 1);
  withdrawn.probability = 0;
  earlier.other_epoch = KnownTeam::kEpoch - 1;
  sure.T_own_other = KnownTeam::pose(SE3(), 1e-7, 1e-7);
  std::uint16_t index = 0;
  for (const peers::Edge& edge : {withdrawn, earlier, sure, edge_to(1, 1), edge_to(9, 1)}) publish(1, index++, edge);
  EXPECT_EQ(claims().size(), 1U) << "that of robot 2";
}

TEST_F(PublishedClaims, OfManyOfOneOriginOnlyTheFirstCount) {
  for (std::uint16_t i = 0; i < 300; ++i) publish(1, edge_index(EdgeOrigin::kRefined, i), edge_to(2, i));
  publish(1, edge_index(EdgeOrigin::kDeployed, 0), edge_to(2, 0));
  EXPECT_EQ(claims().size(), kMostClaimsPerOrigin + 2);
}

TEST_F(PublishedClaims, AChainEndsAtItsFirstGap) {
  const auto submap = [&](std::uint16_t k, double sigma_m) {
    team_.publish(2, peers::ItemId::submap(k),
                  encode(peers::Submap{KnownTeam::pose(KnownTeam::at(48 * k, 0), sigma_m, sigma_m)}));
  };
  submap(1, 0.1);
  submap(3, 0.1);
  EXPECT_EQ(published_chains(team_.exchange.layers()).at(2).size(), 1U);
  submap(2, 0.1);
  const auto chains = published_chains(team_.exchange.layers());
  ASSERT_EQ(chains.at(2).size(), 3U);
  EXPECT_EQ(chains.at(2)[1].mean.translation().x(), 96);
  EXPECT_FALSE(chains.contains(1));
  submap(2, 1e-7);
  EXPECT_EQ(published_chains(team_.exchange.layers()).at(2).size(), 1U) << "singular";
}

TEST(EdgeIndex, SaysTheOrigin) {
  for (const auto origin : {EdgeOrigin::kMatched, EdgeOrigin::kRefined, EdgeOrigin::kSurveyed, EdgeOrigin::kDeployed})
    for (const std::size_t nth : {std::size_t{0}, std::size_t{kEdgesPerOrigin} - 1})
      EXPECT_EQ(origin_of(edge_index(origin, nth)), origin);
  EXPECT_EQ(edge_index(EdgeOrigin::kRefined, 0), 0x4000);
  EXPECT_EQ(edge_index(EdgeOrigin::kSurveyed, 0), 0x8000);
  EXPECT_EQ(edge_index(EdgeOrigin::kDeployed, 0), 0xC000);
}

}  // namespace
}  // namespace cairn::team
