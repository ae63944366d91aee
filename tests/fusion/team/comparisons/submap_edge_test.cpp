// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/submap_edge.hpp"

#include <gtest/gtest.h>

#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

/// Robot 1 has driven along x, tile by tile, in three submaps; robot 2 has seen a part of that.
KnownTeam three_submaps() {
  KnownTeam team;
  for (int k = 0; k < 3; ++k) team.publish_walls(1, static_cast<std::uint16_t>(k), 30 * k, 30);
  team.chains[1] = {KnownTeam::pose(KnownTeam::at(48, 0), 0.2, 0.01), KnownTeam::pose(KnownTeam::at(96, 0), 0.2, 0.01)};
  return team;
}

const MatchJob kJob{.peer = 2, .own_epoch = KnownTeam::kEpoch, .peer_epoch = 77};

TEST(SubmapEdge, OfOneSubmapEachItIsThePoseOfTheMaps) {
  KnownTeam team;
  team.publish_walls(1, 0, 0, 30);
  team.publish_walls(2, 0, 0, 30);
  const UncertainPose T = KnownTeam::pose(KnownTeam::at(1.6, 0), 0.1, 0.01);
  const peers::Edge edge = submap_edge(kJob, T, team.view());
  EXPECT_EQ(edge.own_submap, 0);
  EXPECT_EQ(edge.other_submap, 0);
  EXPECT_EQ(edge.other, 2U);
  EXPECT_EQ(edge.other_epoch, 77U);
  EXPECT_EQ(edge.T_own_other.mean.matrix(), T.mean.matrix());
  EXPECT_EQ(edge.probability, 0);
}

TEST(SubmapEdge, ItIsAboutTheSubmapsWithMostInCommon) {
  KnownTeam team = three_submaps();
  team.publish_walls(2, 0, 0, 30);
  const SE3 T_own_other = KnownTeam::at(1.6 * 65, 0);  // 25 tiles in submap 2, none in the others
  const peers::Edge edge = submap_edge(kJob, KnownTeam::pose(T_own_other, 0.1, 0.01), team.view());
  EXPECT_EQ(edge.own_submap, 2);
  EXPECT_EQ(edge.other_submap, 0);
  EXPECT_NEAR(edge.T_own_other.mean.translation().x(), 1.6 * 65 - 96, 1e-9);
}

TEST(SubmapEdge, TheDriftThatTheMapsWereFreedOfIsInIt) {
  KnownTeam team = three_submaps();
  team.publish_walls(2, 0, 0, 30);
  MatchJob job{.peer = 2, .own_epoch = KnownTeam::kEpoch, .peer_epoch = 77};
  job.own.T_map_odom[2] = KnownTeam::at(0.5, 0);  // submap 2 lies half a metre further than odom says
  const SE3 T_own_other = KnownTeam::at(1.6 * 65, 0);
  const peers::Edge edge = submap_edge(job, KnownTeam::pose(T_own_other, 0.1, 0.01), team.view());
  EXPECT_EQ(edge.own_submap, 2);
  EXPECT_NEAR(edge.T_own_other.mean.translation().x(), 1.6 * 65 - 96.5, 1e-9);
}

TEST(SubmapEdge, ASubmapWithoutAPlaceInOdomIsNotNamed) {
  KnownTeam team = three_submaps();
  team.chains[1].pop_back();  // submap 2 has no place yet
  team.publish_walls(2, 0, 0, 30);
  const SE3 T_own_other = KnownTeam::at(1.6 * 55, 0);  // 25 tiles in submap 2, 5 in submap 1
  EXPECT_EQ(submap_edge(kJob, KnownTeam::pose(T_own_other, 0.1, 0.01), team.view()).own_submap, 1);
}

}  // namespace
}  // namespace cairn::team
