// SPDX-License-Identifier: Apache-2.0
// What is made of a job that comes back. That a whole map is found is in team_test.cpp.
#include "fusion/team/comparisons/match_results.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

class MatchResultsTest : public testing::Test {
 protected:
  MatchResultsTest() {
    for (const peers::RobotId robot : {1U, 2U}) {
      team_.publish_walls(robot, 0, 0, 40);
      team_.publish_walls(robot, 1, 40, 40);
    }
    team_.poses.submaps = {{{1, 0}, SE3()}, {{1, 1}, SE3()}, {{2, 0}, SE3()}, {{2, 1}, SE3()}};
  }
  ComparedPeer& peer() { return compared_.at(2, KnownTeam::kEpoch, KnownTeam::kEpoch); }
  MatchJob job_of_whole_maps() {
    peer().worth.begin({}, now_);
    return {.peer = 2,
            .own_epoch = KnownTeam::kEpoch,
            .peer_epoch = KnownTeam::kEpoch,
            .match = std::exchange(peer().match, nullptr)};
  }
  MatchJob job_of_submaps(const std::optional<UncertainPose>& found) {
    (void)peer();
    if (!submaps_)
      submaps_ = compared_.refinements().next(1, 2, team_.tiles.of(1), team_.tiles.of(2), team_.poses, 1.6);
    return {.peer = 2,
            .own_epoch = KnownTeam::kEpoch,
            .peer_epoch = KnownTeam::kEpoch,
            .refinement = Refinement{.submaps = submaps_.value(), .found = found, .probability = 0.97},
            .ran = true};
  }
  std::optional<IndexedEdge> take(MatchJob job) { return take_result(std::move(job), team_.view(), compared_, now_); }
  static UncertainPose found_at(double x) { return KnownTeam::pose(KnownTeam::at(x, 0), 0.02, 0.002); }

  KnownTeam team_;
  ComparedPeers compared_{MatchWorthConfig{}};
  std::optional<SubmapPair> submaps_;
  Time now_{std::chrono::seconds(100)};
};

TEST_F(MatchResultsTest, AJobThatThereWasNoTimeForChangesNothing) {
  auto job = job_of_whole_maps();
  const auto* match = job.match.get();
  EXPECT_FALSE(take(std::move(job)));
  EXPECT_EQ(peer().match.get(), match) << "it can be handed out again";
}

TEST_F(MatchResultsTest, AJobIsVoidAfterABeginning) {
  auto job = job_of_whole_maps();
  job.ran = true;
  const ComparedPeer& anew = compared_.at(2, KnownTeam::kEpoch, KnownTeam::kEpoch + 1);
  const auto* match = anew.match.get();
  EXPECT_FALSE(take(std::move(job)));
  EXPECT_EQ(anew.match.get(), match);
}

TEST_F(MatchResultsTest, NothingIsPublishedOfAPeerThatWasNotFound) {
  auto job = job_of_whole_maps();
  job.ran = true;
  EXPECT_FALSE(take(std::move(job)));
  EXPECT_FALSE(peer().found);
  EXPECT_FALSE(peer().edge.stands());
}

TEST_F(MatchResultsTest, TwoSubmapsThatWereFoundAreAnEdge) {
  const auto edge = take(job_of_submaps(found_at(0.1)));
  ASSERT_TRUE(edge);
  EXPECT_EQ(origin_of(edge->index), EdgeOrigin::kRefined);
  EXPECT_EQ(edge->edge.other, 2U);
  EXPECT_EQ(edge->edge.other_epoch, KnownTeam::kEpoch);
  EXPECT_EQ(edge->edge.own_submap, submaps_->own);
  EXPECT_EQ(edge->edge.other_submap, submaps_->other);
  EXPECT_EQ(edge->edge.probability, 0.97F);
  EXPECT_FALSE(take(job_of_submaps(found_at(0.11)))) << "it has hardly moved";
  EXPECT_FALSE(take(job_of_submaps({}))) << "what was found once stands";
  EXPECT_TRUE(take(job_of_submaps(found_at(0.2))));
}

TEST_F(MatchResultsTest, SubmapsThatAreVoidSinceAreNoEdge) {
  auto job = job_of_submaps(found_at(0.1));
  (void)compared_.at(3, KnownTeam::kEpoch, KnownTeam::kEpoch);  // a robot joins meanwhile
  compared_.refinements().clear();
  EXPECT_FALSE(take(std::move(job)));
}

}  // namespace
}  // namespace cairn::team
