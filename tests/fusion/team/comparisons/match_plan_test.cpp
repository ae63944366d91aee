// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_plan.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

using std::chrono::seconds;

class MatchPlanTest : public testing::Test {
 protected:
  static constexpr std::size_t kLeastTiles = 10;

  std::optional<MatchJob> next() { return plan_.next(team_.view(), compared_, now_); }
  /// The job comes back; nothing was found.
  void give_back(MatchJob job) {
    plan_.done();
    ComparedPeer* peer = compared_.of(job, KnownTeam::kEpoch);
    ASSERT_NE(peer, nullptr);
    if (job.refinement) return;
    peer->match = std::move(job.match);
    peer->worth.end(false, now_);
  }

  KnownTeam team_;
  MatchWorthConfig config_;
  ComparedPeers compared_{config_};
  MatchPlan plan_{config_, kLeastTiles};
  Time now_{seconds(100)};
};

TEST_F(MatchPlanTest, ComparesWithPeersOfAHigherIdOneAtATime) {
  team_.publish_walls(1, 0, 0, 12);
  EXPECT_FALSE(next()) << "nobody else is there";
  team_.publish_walls(2, 0, 0, 9);
  EXPECT_FALSE(next()) << "the peer has too little";
  team_.publish_walls(3, 0, 0, 11);
  auto job = next();
  ASSERT_TRUE(job);
  EXPECT_EQ(job->peer, 3U);
  EXPECT_EQ(job->own.tiles.size(), 12U);
  EXPECT_EQ(job->other.tiles.size(), 11U);
  EXPECT_TRUE(job->match);
  EXPECT_FALSE(job->refinement);
  team_.publish_walls(2, 0, 9, 9);
  EXPECT_FALSE(next()) << "a job is out";
  give_back(*std::move(job));
  job = next();
  ASSERT_TRUE(job);
  EXPECT_EQ(job->peer, 2U);
}

TEST_F(MatchPlanTest, TheHigherOfTwoRobotsDoesNotCompare) {
  team_.publish_walls(1, 0, 0, 20);
  team_.publish_walls(2, 0, 0, 20);
  const peers::Exchange& self = team_.exchange;
  ASSERT_EQ(self.self(), 1U);
  peers::Exchange two(2, "robot_2", KnownTeam::kEpoch);
  const TeamView of_two{.exchange = two,
                        .tiles = team_.tiles,
                        .poses = team_.poses,
                        .chains = team_.chains,
                        .resolution_m = KnownTeam::kResolution_m};
  EXPECT_FALSE(plan_.next(of_two, compared_, now_));
}

TEST_F(MatchPlanTest, OfTwoThatAreWorthTheSameTheOneThatWasComparedLongerAgoIsNext) {
  team_.publish_walls(1, 0, 0, 20);
  team_.publish_walls(2, 0, 0, 20);
  team_.publish_walls(3, 0, 0, 20);
  std::vector<peers::RobotId> order;
  for (int i = 1; i <= 6; ++i, now_ += seconds(30)) {
    team_.publish_walls(1, 0, 20 * i, 20);  // growth makes both due
    auto job = next();
    ASSERT_TRUE(job);
    order.push_back(job->peer);
    give_back(*std::move(job));
  }
  EXPECT_EQ(order, (std::vector<peers::RobotId>{2, 3, 2, 3, 2, 3}));
}

TEST_F(MatchPlanTest, AJobKnowsTheDeploymentsAndTheDrift) {
  team_.publish_walls(1, 0, 0, 20);
  team_.publish_walls(2, 0, 0, 20);
  team_.deploy(1, KnownTeam::at(1, 0), 0.5, 0.05);
  team_.deploy(2, KnownTeam::at(4, 0), 0.5, 0.05);
  team_.poses.submaps = {{{2, 0}, KnownTeam::at(0, 0)}, {{2, 1}, KnownTeam::at(0.5, 0)}};
  const auto job = next();
  ASSERT_TRUE(job && job->guess);
  EXPECT_NEAR(job->guess->mean.translation().x(), 3, 1e-9);
  EXPECT_TRUE(job->own.T_map_odom.empty());
  EXPECT_NEAR(job->other.T_map_odom_of(1).translation().x(), 0.5, 1e-9);
}

TEST_F(MatchPlanTest, WithoutWholeMapsToCompareItComparesSubmapsOfTheTeam) {
  for (const peers::RobotId robot : {1U, 2U}) {
    team_.publish_walls(robot, 0, 0, 40);
    team_.publish_walls(robot, 1, 40, 40);
    team_.chains[robot] = {KnownTeam::pose(KnownTeam::at(64, 0), 0.2, 0.01)};
  }
  const std::vector<PairClaim> claims{
      {.a = 1, .b = 2, .T_a_b = KnownTeam::pose(SE3(), 0.1, 0.01), .probability = 0.97}};
  team_.poses = team_poses(1, claims, team_.chains);
  give_back(*next());
  std::set<SubmapPair> pairs;
  while (auto job = next()) {
    ASSERT_TRUE(job->refinement);
    EXPECT_FALSE(job->match);
    EXPECT_EQ(job->own.tiles.size(), 40U);
    const std::uint16_t submap = job->refinement->submaps.own;
    EXPECT_NEAR(job->own.T_map_odom_of(submap).translation().x(), -64.0 * submap, 1e-9);
    pairs.insert(job->refinement->submaps);
    give_back(*std::move(job));
    now_ += config_.period;
  }
  EXPECT_EQ(pairs, (std::set<SubmapPair>{{2, 0, 0}, {2, 1, 1}}));
}

}  // namespace
}  // namespace cairn::team
