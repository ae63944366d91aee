// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_outlook.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

using matching::PendingHypotheses;

TEST(MatchOutlook, CountsWhatBothHavePublished) {
  KnownTeam team;
  team.publish_walls(1, 0, 0, 20);
  team.publish_walls(2, 0, 5, 30);
  team.publish_walls(2, 0, 5, 1);  // again
  const MatchOutlook outlook = outlook_of(team.view(), 2, matching::PendingHypotheses{});
  EXPECT_EQ(outlook.own_tiles, 20U);
  EXPECT_EQ(outlook.peer_tiles, 30U);
  EXPECT_EQ(outlook.own_version, 20U);
  EXPECT_EQ(outlook.peer_version, 31U);
  EXPECT_FALSE(outlook.common_tiles) << "nobody knows where the peer is";
  EXPECT_FALSE(outlook.merged);
}

TEST(MatchOutlook, OfATeamsMemberItKnowsWhatIsCommon) {
  KnownTeam team;
  team.publish_walls(1, 0, 0, 20);
  team.publish_walls(2, 0, 0, 20);
  team.poses.T_team_odom = {{1, KnownTeam::at(3, 4)}, {2, KnownTeam::at(3 + 5 * 1.6, 4)}};
  const MatchOutlook outlook = outlook_of(team.view(), 2, matching::PendingHypotheses{});
  EXPECT_TRUE(outlook.merged);
  ASSERT_TRUE(outlook.common_tiles);
  EXPECT_NEAR(static_cast<double>(*outlook.common_tiles), 15, 1);
}

TEST(MatchOutlook, APoseIsTheTeamsElseThatOfThePlaceElseThatOfTheDeployments) {
  KnownTeam team;
  PendingHypotheses none, places;
  places.take({agreeing(KnownTeam::at(2, 0))});
  ASSERT_GT(places.all().front().probability_correct, 0.5);
  EXPECT_FALSE(likely_pose(team.view(), 2, none));

  team.deploy(1, KnownTeam::at(0, 0), 0.1, 0.01);
  team.deploy(2, KnownTeam::at(3, 0), 0.1, 0.01);
  EXPECT_NEAR(likely_pose(team.view(), 2, none)->translation().x(), 3, 1e-9);
  EXPECT_NEAR(likely_pose(team.view(), 2, places)->translation().x(), 2, 1e-9);

  team.poses.T_team_odom = {{1, KnownTeam::at(5, 0)}, {2, KnownTeam::at(6, 0)}};
  EXPECT_NEAR(likely_pose(team.view(), 2, places)->translation().x(), 1, 1e-9);
}

TEST(MatchOutlook, AVagueDeploymentIsNoPose) {
  KnownTeam team;
  team.deploy(1, KnownTeam::at(0, 0), 1.5, 0.01);
  team.deploy(2, KnownTeam::at(3, 0), 1.5, 0.01);
  EXPECT_FALSE(likely_pose(team.view(), 2, matching::PendingHypotheses{})) << "a tile is 1.6 m";
}

TEST(MatchOutlook, CommonTilesAreThoseThatLieOnEachOther) {
  std::set<mapping::TileKey> row, turned;  // along x, and the same as a robot sees it whose x axis is the other's −y
  for (int i = 0; i < 3000; ++i) {
    row.insert(mapping::TileKey::of_voxel(static_cast<std::uint16_t>(32768 + 8 * i), 32768, 32768));
    turned.insert(mapping::TileKey::of_voxel(32768, static_cast<std::uint16_t>(32768 - 8 * i), 32768));
  }
  const auto at = [](double x, double y, double yaw) {
    return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished());
  };
  EXPECT_EQ(tiles_of_both(row, row, SE3(), 0.2), 3000U);
  EXPECT_NEAR(static_cast<double>(tiles_of_both(row, row, at(1500 * 1.6, 0, 0), 0.2)), 1500, 30);
  EXPECT_EQ(tiles_of_both(row, row, at(0, 5, 0), 0.2), 0U);
  EXPECT_LT(tiles_of_both(row, turned, SE3(), 0.2), 60U);
  EXPECT_GT(tiles_of_both(row, turned, at(0, 0, std::numbers::pi / 2), 0.2), 2900U);
  EXPECT_EQ(tiles_of_both(row, row, at(1e6, 0, 0), 0.2), 0U);
}

}  // namespace
}  // namespace cairn::team
