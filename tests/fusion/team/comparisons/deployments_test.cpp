// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/deployments.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

#include "fusion/matching/belief/guess.hpp"
#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

using matching::PendingHypotheses;

class DeploymentsTest : public testing::Test {
 protected:
  void deploy_both(double sigma_m, double sigma_rad) {
    team_.deploy(1, KnownTeam::at(1, 2), sigma_m, sigma_rad);
    team_.deploy(2, KnownTeam::at(4, 6), sigma_m, sigma_rad);
  }
  std::vector<IndexedEdge> edges() { return deployment_edges(team_.view(), compared_); }
  ComparedPeer& peer() { return compared_.at(2, KnownTeam::kEpoch, KnownTeam::kEpoch); }
  void publish(const IndexedEdge& edge) { team_.publish(1, peers::ItemId::edge(edge.index), encode(edge.edge)); }

  KnownTeam team_;
  ComparedPeers compared_{MatchWorthConfig{}};
};

TEST_F(DeploymentsTest, ThePoseBetweenTwoIsKnownWhenBothAre) {
  team_.deploy(1, KnownTeam::at(1, 2), 0.1, 0.01);
  EXPECT_FALSE(deployed_between(team_.exchange.layers(), 1, 2));
  team_.deploy(2, KnownTeam::at(4, 6), 0.1, 0.01);
  const auto T = deployed_between(team_.exchange.layers(), 1, 2);
  ASSERT_TRUE(T);
  EXPECT_LT((T->mean.translation() - Eigen::Vector3d(3, 4, 0)).norm(), 1e-9);
  EXPECT_NEAR(T->covariance(5, 5), 2 * 0.01 * 0.01, 1e-9);
  EXPECT_FALSE(deployed_between(team_.exchange.layers(), 1, 9)) << "never heard of";
}

TEST_F(DeploymentsTest, ExactOnesAreAnEdge) {
  deploy_both(0.05, 0.003);
  const auto edges = this->edges();
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(origin_of(edges[0].index), EdgeOrigin::kDeployed);
  EXPECT_EQ(edges[0].edge.other, 2U);
  EXPECT_FLOAT_EQ(edges[0].edge.probability, static_cast<float>(1 - matching::kWrongGuess));
}

TEST_F(DeploymentsTest, RoughOnesAreNone) {
  deploy_both(0.5, 0.05);
  EXPECT_TRUE(edges().empty());
}

TEST_F(DeploymentsTest, ItIsWithdrawnOnceTheMapsKnowBetter) {
  deploy_both(0.05, 0.003);
  peer().found = true;
  EXPECT_TRUE(edges().empty()) << "nothing was published";
  peer().found = false;
  publish(edges().at(0));
  for (bool* known : {&peer().found, &peer().deployment_refuted}) {
    *known = true;
    ASSERT_EQ(edges().size(), 1U);
    EXPECT_EQ(edges()[0].edge.probability, 0);
    *known = false;
    EXPECT_GT(edges().at(0).edge.probability, 0);
  }
}

TEST_F(DeploymentsTest, AreRefutedWhenTheirPlaceIsDroppedOrAnotherAgrees) {
  const UncertainPose deployed = KnownTeam::pose(KnownTeam::at(3, 4), 0.1, 0.02);
  PendingHypotheses here, elsewhere, dropped;
  EXPECT_FALSE(refutes(here, deployed));
  here.take({agreeing(deployed.mean)});
  EXPECT_FALSE(refutes(here, deployed));
  elsewhere.take({agreeing(KnownTeam::at(9, 4))});
  EXPECT_TRUE(refutes(elsewhere, deployed));
  dropped.take({agreeing(deployed.mean)});
  for (int i = 0; i < 2; ++i) dropped.take({contradicting(deployed.mean)});
  EXPECT_TRUE(refutes(dropped, deployed));
}

TEST_F(DeploymentsTest, AFaultNamesHowFarTheyAreOff) {
  EXPECT_EQ(deployment_fault(team_.view(), nullptr, 2), "");
  deploy_both(0.05, 0.003);
  EXPECT_EQ(deployment_fault(team_.view(), nullptr, 2), "");
  peer().deployment_refuted = true;
  EXPECT_EQ(deployment_fault(team_.view(), &peer(), 2), "; the maps contradict the deployments of the two");
  team_.poses.T_team_odom = {{1, SE3()}, {2, KnownTeam::at(3, 4)}};
  EXPECT_EQ(deployment_fault(team_.view(), &peer(), 2), "");
  team_.poses.T_team_odom[2] = KnownTeam::at(3, 6);
  EXPECT_EQ(deployment_fault(team_.view(), &peer(), 2),
            "; the deployments of the two contradict that by 2.0 m and 0.0 degrees");
}

class FirmDeploymentsTest : public DeploymentsTest {
 protected:
  /// A robot publishes where a person has put it, in a teammate's odom.
  void put(peers::RobotId robot, peers::RobotId ref, const SE3& T_ref_odom, std::uint32_t times = 1,
           peers::Epoch epoch = KnownTeam::kEpoch) {
    const peers::Deployment said{KnownTeam::pose(T_ref_odom, 0.5, 0.2), ref, ref == 0 ? 0 : epoch, times};
    team_.publish(robot, peers::ItemId::deployment(), encode(said));
  }
  /// Metres from where b is by what was said; none: nothing is known.
  [[nodiscard]] std::optional<double> off(peers::RobotId a, peers::RobotId b, const SE3& truth) const {
    const auto T = deployed_between(team_.exchange.layers(), a, b);
    return T ? std::optional((T->mean.inverse() * truth).log().norm()) : std::nullopt;
  }
  void hear_of(peers::RobotId robot) { team_.publish_walls(robot, 0, 0, 1); }
};

TEST_F(FirmDeploymentsTest, InTheOdomOfATeammate) {
  hear_of(1);
  put(2, 1, KnownTeam::at(3, 4, 0.5));
  EXPECT_LT(off(1, 2, KnownTeam::at(3, 4, 0.5)).value(), 1e-9);
  EXPECT_LT(off(2, 1, KnownTeam::at(3, 4, 0.5).inverse()).value(), 1e-9);
  put(3, 2, KnownTeam::at(1, 0));
  EXPECT_LT(off(1, 3, KnownTeam::at(3, 4, 0.5) * KnownTeam::at(1, 0)).value(), 1e-9) << "by the one between";
  team_.deploy(1, KnownTeam::at(10, 0), 0.1, 0.1);
  team_.deploy(4, KnownTeam::at(12, 0), 0.1, 0.1);
  EXPECT_LT(off(4, 2, KnownTeam::at(-2, 0) * KnownTeam::at(3, 4, 0.5)).value(), 1e-9) << "by the shared frame";
}

TEST_F(FirmDeploymentsTest, ACircleSaysNothingOfAThird) {
  for (const peers::RobotId robot : std::initializer_list<peers::RobotId>{1, 2, 3}) hear_of(robot);
  put(2, 3, KnownTeam::at(1, 0));
  put(3, 2, KnownTeam::at(-1, 0));
  EXPECT_FALSE(off(1, 2, SE3()));
  EXPECT_LT(off(2, 3, KnownTeam::at(-1, 0)).value(), 1e-9) << "what the higher one says";
}

TEST_F(FirmDeploymentsTest, ItEndsWithTheOdomOfTheTeammate) {
  hear_of(1);
  put(2, 1, KnownTeam::at(3, 4), 1, KnownTeam::kEpoch - 1);
  EXPECT_FALSE(off(1, 2, SE3())) << "of an earlier beginning";
  EXPECT_EQ(firmness(team_.exchange.layers(), 1, 2), 0U);
}

TEST_F(FirmDeploymentsTest, WhatWasFoundIsWithdrawnOnce) {
  hear_of(2);
  (void)peer().edge.update(peers::Edge{.other = 2, .T_own_other = {}, .probability = 0.9F});
  EXPECT_TRUE(heed_firm(team_.view(), compared_).empty());
  put(2, 1, KnownTeam::at(3, 4));
  const auto withdrawn = heed_firm(team_.view(), compared_);
  ASSERT_EQ(withdrawn.size(), 1U);
  EXPECT_EQ(withdrawn[0].edge.probability, 0);
  EXPECT_TRUE(heed_firm(team_.view(), compared_).empty());
}

TEST_F(FirmDeploymentsTest, ProfilesAreOnlyAGuess) {
  deploy_both(0.5, 0.05);
  EXPECT_EQ(firmness(team_.exchange.layers(), 1, 2), 0U);
  put(2, 0, KnownTeam::at(3, 4), 3);
  EXPECT_EQ(firmness(team_.exchange.layers(), 1, 2), 3U);
}

}  // namespace
}  // namespace cairn::team
