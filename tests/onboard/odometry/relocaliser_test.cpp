// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/relocaliser.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::odometry {
namespace {

const Vector6 kDriving = (Vector6() << 1.5, 0, 0, 0, 0, 0.5).finished();
const SE3 kEnd = SE3::from_xyz_rpy((Vector6() << 7, -2, 0, 0, 0, 1).finished());
constexpr std::size_t kKeypoints = 2000;

/// A fit with so many inliers, this far ahead of where the previous run ended.
Fit fit_with(int inliers, double ahead_m = 0.3) {
  Fit out;
  out.state.T_odom_base = kEnd * SE3::exp(ahead_m * Vector6::Unit(0));
  out.equations.matched = 1800;
  out.equations.inliers = inliers;
  return out;
}

Relocaliser expecting(double known_share) {
  Relocaliser relocaliser({});
  (void)relocaliser.expect({kEnd, Matrix6::Zero()}, kDriving);
  relocaliser.compare_with(known_share);
  return relocaliser;
}

TEST(Relocaliser, WithoutARestartNothingIsAsked) {
  Relocaliser relocaliser({});
  EXPECT_FALSE(relocaliser.pending());
  EXPECT_EQ(relocaliser.judge(fit_with(0), kKeypoints), Relocalisation::kNotNeeded);
  EXPECT_EQ(relocaliser.moving_time_s(7), 7);
}

TEST(Relocaliser, ExpectsTheRobotWithinItsBrakingWay) {
  Relocaliser relocaliser({});
  const Matrix6 covariance = 0.04 * Matrix6::Identity();
  const MotionFilter::Uncertainty u = relocaliser.expect({kEnd, covariance}, kDriving);
  EXPECT_TRUE(relocaliser.pending());
  const auto sigma = [&](int k) { return std::sqrt(u.local(k, k)); };
  EXPECT_NEAR(sigma(0), 0.15 + 0.17 * 1.5, 1e-12) << "along the way it may have come farther";
  EXPECT_NEAR(sigma(1), 0.15, 1e-12);
  EXPECT_NEAR(sigma(5), 0.15 + 0.17 * 0.5, 1e-12);
  EXPECT_NEAR(sigma(6), 0.2, 1e-12);
  EXPECT_LT((u.total.topLeftCorner<6, 6>() - u.local.topLeftCorner<6, 6>() - covariance).norm(), 1e-12)
      << "against the start, the saved pose's error comes on top";
}

TEST(Relocaliser, AFirstScanThatKnowsItsSurroundingsIsFound) {
  Relocaliser relocaliser = expecting(0.9);
  EXPECT_EQ(relocaliser.judge(fit_with(1480), kKeypoints), Relocalisation::kFound) << "0.82 of 0.9 of 2000 are 1476";
  EXPECT_FALSE(relocaliser.pending());
  EXPECT_EQ(relocaliser.judge(fit_with(0), kKeypoints), Relocalisation::kNotNeeded) << "asked once";
}

TEST(Relocaliser, ARobotThatWasCarriedAwayIsElsewhere) {
  EXPECT_EQ(expecting(0.9).judge(fit_with(1470), kKeypoints), Relocalisation::kElsewhere) << "too little is known";
  EXPECT_EQ(expecting(0.9).judge(fit_with(1800, 2.0), kKeypoints), Relocalisation::kElsewhere) << "too far";
  Fit nothing = fit_with(0);
  nothing.equations.matched = 59;
  EXPECT_EQ(expecting(0).judge(nothing, kKeypoints), Relocalisation::kElsewhere) << "too few matches";
  Relocaliser relocaliser = expecting(0.9);
  (void)relocaliser.judge(fit_with(0), kKeypoints);
  EXPECT_FALSE(relocaliser.pending());
}

TEST(Relocaliser, AScanOfFewPointsDecidesNothing) {
  Relocaliser relocaliser = expecting(0.9);
  EXPECT_EQ(relocaliser.judge(fit_with(1800), 240), Relocalisation::kUndecided);
  EXPECT_TRUE(relocaliser.pending()) << "the next scan is asked";
  EXPECT_EQ(relocaliser.judge(fit_with(1800), kKeypoints), Relocalisation::kFound);
}

TEST(Relocaliser, ALongAbsenceMovesTheRobotNoFarther) {
  Relocaliser relocaliser = expecting(0.9);
  EXPECT_EQ(relocaliser.moving_time_s(0.4), 0.4);
  EXPECT_EQ(relocaliser.moving_time_s(3600), 1.0);
}

TEST(Relocaliser, EveryAnswerHasAName) {
  EXPECT_EQ(to_string(Relocalisation::kNotNeeded), "not needed");
  EXPECT_EQ(to_string(Relocalisation::kUndecided), "undecided");
  EXPECT_EQ(to_string(Relocalisation::kFound), "found");
  EXPECT_EQ(to_string(Relocalisation::kElsewhere), "elsewhere");
}

}  // namespace
}  // namespace cairn::odometry
