// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/tracking_state.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

constexpr double kScan_s = 0.1;

Time time_at(double seconds) { return Time{from_seconds(seconds)}; }
SE3 driven(double metres) { return SE3(Eigen::Quaterniond::Identity(), {metres, 0, 0}); }
SE3 turned(double radians) { return SE3::exp(radians * Vector6::Unit(5)); }

Fit fit_with(int matched, int inliers) {
  Fit out;
  out.equations.matched = matched;
  out.equations.inliers = inliers;
  return out;
}

PatchMap map_of(std::size_t points) {
  PatchMap map({.finest_block_m = 0.5, .max_blocks = 1 << 12, .max_points_per_block = 400, .criteria = {}});
  Workers workers(1);
  map.insert(Room(1).points(points, 0.01), Room::sensor(), 0, workers);
  return map;
}

class Tracking : public ::testing::Test {
 protected:
  static constexpr int kPatience = 4;
  Track judge(const Fit& f, const SE3& motion = {}, bool sure = true) {
    return state_.judge(f, motion, kScan_s, map_, sure, kPatience);
  }
  TrackingState state_{OdometryConfig{}};
  PatchMap map_ = map_of(5000), empty_ = map_of(0);
};

TEST_F(Tracking, BeginsWithTheFirstScan) {
  EXPECT_FALSE(state_.began());
  state_.begin(time_at(3));
  EXPECT_TRUE(state_.began());
  EXPECT_NEAR(state_.seconds_since_last(time_at(3.1)), 0.1, 1e-12);
  state_.advance(time_at(3.1), 0.1);
  EXPECT_NEAR(state_.seconds_since_last(time_at(3.0)), -0.1, 1e-12);
}

TEST_F(Tracking, KnowsHowLongAgoAScanWasFollowed) {
  state_.begin(time_at(0));
  state_.advance(time_at(0.1), 0.1);
  EXPECT_EQ(judge(fit_with(100, 10)), Track::kLost);
  EXPECT_TRUE(state_.lost());
  EXPECT_NEAR(state_.seconds_since_followed(time_at(0.2)), 0.2, 1e-12);
  EXPECT_NEAR(state_.seconds_since_last(time_at(0.2)), 0.1, 1e-12);
  state_.advance(time_at(0.2), 0.1);
  EXPECT_EQ(judge(fit_with(100, 90)), Track::kFollowed);
  EXPECT_FALSE(state_.lost());
  EXPECT_NEAR(state_.seconds_since_followed(time_at(0.3)), 0.1, 1e-12);
}

TEST_F(Tracking, AFragmentAfterAGapIsToldFromAWholeScan) {
  state_.begin(time_at(0));
  EXPECT_FALSE(state_.is_fragment_after_gap(10, 0.001)) << "how long a whole one takes is not known yet";
  state_.advance(time_at(0.1), 0.1);
  EXPECT_TRUE(state_.is_fragment_after_gap(0.19, 0.05));
  EXPECT_FALSE(state_.is_fragment_after_gap(0.19, 0.07)) << "most of a revolution";
  EXPECT_FALSE(state_.is_fragment_after_gap(0.12, 0.05)) << "no gap";
  EXPECT_TRUE(state_.is_fragment(0.05));
  EXPECT_FALSE(state_.is_fragment(0.07));
}

TEST_F(Tracking, AMotorMayTurnFasterFromNowOn) {
  state_.begin(time_at(0));
  state_.advance(time_at(0.2), 0.2);
  EXPECT_TRUE(state_.is_fragment_after_gap(0.5, 0.1));
  for (int i = 0; i < 7; ++i) state_.advance(time_at(0.3 + 0.1 * i), 0.1);
  EXPECT_FALSE(state_.is_fragment_after_gap(0.5, 0.1));
}

TEST_F(Tracking, AShortPieceSaysLittleOfHowLongARevolutionTakes) {
  state_.begin(time_at(0));
  state_.advance(time_at(0.1), 0.1);
  EXPECT_FALSE(state_.last_was_fragment());
  state_.advance(time_at(0.101), 0.001);
  EXPECT_TRUE(state_.last_was_fragment());
  EXPECT_TRUE(state_.is_fragment(0.058));
}

TEST_F(Tracking, AFitIsFollowedIfEnoughPointsMatchAndFit) {
  EXPECT_EQ(judge(fit_with(60, 24)), Track::kFollowed);
  EXPECT_EQ(judge(fit_with(59, 59)), Track::kLost) << "too few matches";
  EXPECT_EQ(judge(fit_with(100, 39)), Track::kLost) << "too few of them fit";
}

TEST_F(Tracking, WhereFewDirectionsAreSeenFewMatchesAreEnough) {
  Fit fit = fit_with(30, 30);
  for (const int degenerate : {0, 1, 2}) {
    fit.degeneracy.count = degenerate;
    EXPECT_EQ(judge(fit), Track::kLost) << degenerate;
  }
  fit.degeneracy.count = 3;
  EXPECT_EQ(judge(fit), Track::kFollowed);
  fit = fit_with(19, 19);
  fit.degeneracy.count = 6;
  EXPECT_EQ(judge(fit), Track::kLost) << "too few to say anything";
}

TEST_F(Tracking, AMotionThatNoRobotMakesIsNotFollowed) {
  EXPECT_EQ(judge(fit_with(100, 100), driven(4.9)), Track::kFollowed) << "49 m/s";
  EXPECT_EQ(judge(fit_with(100, 100), driven(5.1)), Track::kLost);
  EXPECT_EQ(judge(fit_with(100, 100), turned(0.59)), Track::kFollowed) << "5.9 rad/s";
  EXPECT_EQ(judge(fit_with(100, 100), turned(0.61)), Track::kLost);
}

TEST_F(Tracking, LostScansInARowBeginANewMap) {
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(judge(fit_with(0, 0)), Track::kLost) << i;
    EXPECT_EQ(judge(fit_with(0, 0)), Track::kReinitialised);
  }
  for (int i = 0; i < 3; ++i) (void)judge(fit_with(0, 0));
  EXPECT_EQ(judge(fit_with(100, 100)), Track::kFollowed);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(judge(fit_with(0, 0)), Track::kLost) << "the count begins again";
}

TEST_F(Tracking, AMapWithoutPatchesIsGivenUpAtOnce) {
  EXPECT_EQ(state_.judge(fit_with(0, 0), {}, kScan_s, empty_, true, kPatience), Track::kReinitialised);
}

TEST_F(Tracking, AFitThatMayBeOfAnotherPlaceIsNotFollowed) {
  EXPECT_EQ(judge(fit_with(100, 100), {}, false), Track::kLost);
}

TEST_F(Tracking, EveryOutcomeHasAName) {
  EXPECT_EQ(to_string(Track::kFollowed), "followed");
  EXPECT_EQ(to_string(Track::kLost), "lost");
  EXPECT_EQ(to_string(Track::kReinitialised), "reinitialised");
}

}  // namespace
}  // namespace cairn::odometry
