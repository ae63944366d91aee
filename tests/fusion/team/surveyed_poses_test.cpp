// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/surveyed_poses.hpp"

#include <gtest/gtest.h>

#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

TEST(SurveyedPoses, AreEdgesAboutTheBeginningsOfPeersThatWereHeardOf) {
  SurveyedPoses poses;
  poses.set(3, KnownTeam::pose(KnownTeam::at(3, 0), 0.1, 0.01), 0.99);
  poses.set(2, KnownTeam::pose(KnownTeam::at(2, 0), 0.1, 0.01), 0.9);
  KnownTeam team;
  EXPECT_TRUE(poses.edges(team.exchange.layers()).empty());
  team.publish_walls(3, 0, 0, 1);
  const auto edges = poses.edges(team.exchange.layers());
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0].index, edge_index(EdgeOrigin::kSurveyed, 1)) << "the index does not change when 2 is heard of";
  EXPECT_EQ(edges[0].edge.other, 3U);
  EXPECT_EQ(edges[0].edge.other_epoch, KnownTeam::kEpoch);
  EXPECT_EQ(edges[0].edge.probability, 0.99F);
  team.publish_walls(2, 0, 0, 1);
  EXPECT_EQ(poses.edges(team.exchange.layers()).size(), 2U);
}

TEST(SurveyedPoses, ALaterOneReplacesTheEarlier) {
  SurveyedPoses poses;
  KnownTeam team;
  team.publish_walls(2, 0, 0, 1);
  for (const double x : {1.0, 4.0}) poses.set(2, KnownTeam::pose(KnownTeam::at(x, 0), 0.1, 0.01), 0.9);
  const auto edges = poses.edges(team.exchange.layers());
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0].edge.T_own_other.mean.translation().x(), 4);
}

}  // namespace
}  // namespace cairn::team
