// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/tiles/team_tiles.hpp"

#include <gtest/gtest.h>

namespace cairn::team {
namespace {

TEST(TeamTiles, ARobotOfWhichNothingIsKnownHasNone) {
  const TeamTiles tiles;
  EXPECT_EQ(tiles.walls_of(7), 0U);
  EXPECT_EQ(tiles.version_of(7), 0U);
  EXPECT_TRUE(tiles.of(7).walls_by_submap().empty());
}

TEST(TeamTiles, EachRobotHasItsOwn) {
  TeamTiles tiles;
  EXPECT_FALSE(tiles.put(1, {8}, 0, true));
  EXPECT_FALSE(tiles.put(2, {8}, 0, false));
  EXPECT_EQ(tiles.put(1, {8}, 1, true), 0) << "it was in submap 0";
  EXPECT_EQ(tiles.walls_of(1), 1U);
  EXPECT_EQ(tiles.walls_of(2), 0U);
  EXPECT_EQ(tiles.version_of(1), 2U);
}

TEST(TeamTiles, ABeginningVoidsTheTilesButNotTheVersion) {
  TeamTiles tiles;
  tiles.put(1, {8}, 0, true);
  tiles.forget(1);
  EXPECT_EQ(tiles.walls_of(1), 0U);
  tiles.put(1, {8}, 0, true);
  EXPECT_EQ(tiles.version_of(1), 2U) << "another map than before";
}

}  // namespace
}  // namespace cairn::team
