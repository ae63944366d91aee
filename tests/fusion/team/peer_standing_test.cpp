// SPDX-License-Identifier: Apache-2.0
// The reasons that two whole teams give are in team_standing_test.cpp.
#include "fusion/team/peer_standing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

using ::testing::StartsWith;

class PeerStandingTest : public testing::Test {
 protected:
  [[nodiscard]] PeerStanding standing() const { return standing_of(2, team_.view(), compared_, 10, Time{}); }

  KnownTeam team_;
  ComparedPeers compared_{MatchWorthConfig{}};
};

TEST_F(PeerStandingTest, GoesFromNeverHeardOfToNoPlaceFound) {
  EXPECT_EQ(standing().reason, "never heard of");
  team_.publish_walls(2, 0, 0, 20);
  team_.publish_walls(1, 0, 0, 9);
  EXPECT_EQ(standing().reason, "too little mapped: 9 and 20 tiles with walls, 10 needed");
  team_.publish_walls(1, 0, 9, 9);
  EXPECT_EQ(standing().reason, "being compared");
  (void)compared_.at(2, KnownTeam::kEpoch, KnownTeam::kEpoch);
  EXPECT_EQ(standing().reason, "no place found where the maps overlap");
  EXPECT_FALSE(standing().merged());
}

TEST_F(PeerStandingTest, AMergedPeerMayContradictItsDeployment) {
  team_.poses.T_team_odom = {{1, SE3()}, {2, KnownTeam::at(8, 0)}};
  EXPECT_TRUE(standing().merged());
  EXPECT_EQ(standing().reason, "merged");
  team_.deploy(1, SE3(), 0.1, 0.01);
  team_.deploy(2, KnownTeam::at(3, 0), 0.1, 0.01);
  EXPECT_TRUE(standing().merged());
  EXPECT_EQ(standing().reason, "merged; the deployments of the two contradict that by 5.0 m and 0.0 degrees");
}

TEST_F(PeerStandingTest, ABannedPeerIsNamed) {
  for (int i = 0; i < 10; ++i) {
    auto bytes = peers::encode({.sender = 2, .hello = peers::Hello{}, .digest = {}, .items = {}}).bytes;
    bytes.pop_back();
    EXPECT_FALSE(team_.exchange.receive(bytes, Time{}));
    EXPECT_THAT(standing().reason, StartsWith(i < 9 ? "nothing that it sent" : "banned"));
  }
}

}  // namespace
}  // namespace cairn::team
