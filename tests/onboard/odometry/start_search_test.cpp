// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/start_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "onboard/odometry/estimation/gap_search.hpp"

namespace cairn::odometry {
namespace {

constexpr double kSince_s = 0.1;

/// A filter at rest at the origin, with these standard deviations.
MotionFilter filter(double position_m, double heading_rad, double speed_m_s) {
  Vector12 sigma = Vector12::Constant(0.01);
  sigma[0] = sigma[1] = position_m;
  sigma[5] = heading_rad;
  sigma[6] = speed_m_s;
  MotionFilter::Uncertainty uncertainty;
  uncertainty.local = uncertainty.total = sigma.cwiseAbs2().asDiagonal();
  MotionFilter out;
  out.reset({}, uncertainty);
  return out;
}

/// Keypoints that fit: most at the truth, fewer the farther a hypothesis is from it.
class Agreement {
 public:
  explicit Agreement(const MotionState& truth) : truth_(truth) {}
  StartSearch::Score score() {
    return [this](const MotionState& at, double gate_m) {
      ++calls;
      last_gate_m = gate_m;
      return 1000 * std::exp(-(truth_.T_odom_base.inverse() * at.T_odom_base).log().norm());
    };
  }
  int calls = 0;
  double last_gate_m = 0;

 private:
  MotionState truth_;
};

MotionState at(double x, double y, double yaw) {
  return {SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished()), Vector6::Zero()};
}

TEST(StartSearch, ACertainPredictionIsTheStart) {
  StartSearch search({});
  search.begin_map();
  Agreement world(at(1, 0, 0));
  const MotionState start = search.find(filter(0.1, 0.1, 1.9), kSince_s, world.score());
  EXPECT_EQ(start.T_odom_base.log().norm(), 0);
  EXPECT_EQ(world.calls, 0);
}

TEST(StartSearch, AnUnknownSpeedIsGuessedInSteps) {
  StartSearch search({});
  for (const double speed : {8.0, -3.0}) {
    search.begin_map();
    Agreement world(at(speed * kSince_s, 0, 0));
    const MotionState start = search.find(filter(0.1, 0.1, 10), kSince_s, world.score());
    EXPECT_NEAR(start.twist[0], speed, 1e-9);
    EXPECT_NEAR(start.T_odom_base.translation().x(), speed * kSince_s, 1e-9);
    EXPECT_EQ(world.calls, 41) << "rest, and 1 to 20 m/s in both directions";
    EXPECT_EQ(world.last_gate_m, 0.5);
  }
}

TEST(StartSearch, WhereAllSpeedsLookAlikeRestIsTheStart) {
  StartSearch search({});
  search.begin_map();
  const auto nearly_alike = [](const MotionState& at, double) { return 1000 + std::abs(at.twist[0]); };
  EXPECT_EQ(search.find(filter(0.1, 0.1, 10), kSince_s, nearly_alike).twist[0], 0);
}

TEST(StartSearch, OnlyTheFirstScansOfAMapGuessTheSpeed) {
  StartSearch search({});
  Agreement world(at(0.5, 0, 0));
  const auto guesses = [&] {
    const int before = world.calls;
    (void)search.find(filter(0.1, 0.1, 10), kSince_s, world.score());
    return world.calls > before;
  };
  EXPECT_FALSE(guesses()) << "no map yet";
  for (int map = 0; map < 2; ++map) {
    search.begin_map();
    for (int scan = 0; scan < 3; ++scan) EXPECT_TRUE(guesses());
    EXPECT_FALSE(guesses());
  }
}

TEST(StartSearch, AfterARestartAnUnknownHeadingIsSearchedWithItsPosition) {
  StartSearch search({});
  Agreement world(at(0.75, -0.3, 0.45));
  const MotionState start = search.find_restarted(filter(0.5, 0.3, 1), kSince_s, world.score());
  const MotionState expected = at(0.75, -0.3, 0.45);
  EXPECT_LT((expected.T_odom_base.inverse() * start.T_odom_base).translation().norm(), 0.2);
  EXPECT_LT(rotation_angle(expected.T_odom_base.inverse() * start.T_odom_base), 0.05);
  EXPECT_EQ(world.last_gate_m, 0.2);
}

TEST(GapSearch, StaysWithinThreeStandardDeviationsAndItsReach) {
  Agreement far_away(at(100, 100, 3));
  for (const double sigma : {0.2, 50.0}) {
    const MotionFilter f = filter(sigma, sigma, 1);
    const MotionState start = search_after_gap(f.state(), f.uncertainty().local, kSince_s, [&](const MotionState& x) {
      const Eigen::Vector3d& t = x.T_odom_base.translation();
      EXPECT_LE(t.norm(), std::min(3 * sigma, 4.0) + std::min(3 * sigma, 2.0) + 1e-9);
      EXPECT_LE(rotation_angle(x.T_odom_base), std::min(6 * sigma, 3.0) + 1e-9);
      return far_away.score()(x, 0);
    });
    EXPECT_GT(start.T_odom_base.translation().x(), 0);
  }
  EXPECT_LE(far_away.calls, 2 * 279);
}

TEST(GapSearch, TiesGoToThePrediction) {
  const MotionFilter f = filter(1, 1, 1);
  const MotionState start =
      search_after_gap(f.state(), f.uncertainty().local, kSince_s, [](const MotionState&) { return 5; });
  EXPECT_EQ(start.T_odom_base.log().norm(), 0);
  EXPECT_EQ(start.twist.norm(), 0);
}

TEST(GapSearch, AChangedPoseMeansAnotherMeanTwist) {
  Agreement world(at(0.6, 0, 0));
  const MotionFilter f = filter(1, 0.2, 1);
  const MotionState start = search_after_gap(f.state(), f.uncertainty().local, 0.4,
                                             [&](const MotionState& x) { return world.score()(x, 0); });
  EXPECT_NEAR(start.T_odom_base.translation().x(), 0.6, 1e-9);
  EXPECT_NEAR(start.twist[0], 0.6 / 0.4, 1e-9);
}

}  // namespace
}  // namespace cairn::odometry
