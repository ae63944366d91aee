// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/prior_modes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fusion/matching/default_matcher.hpp"
#include "tests/fusion/matching/planar_pose.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

TEST(Within, IsThreeDeviationsAndACell) {
  // 0.8 m, 0.105 rad.
  const UncertainPose prior{planar_pose(1, 2, 0.5), default_prior_covariance()};
  EXPECT_TRUE(within(prior, prior.mean));
  EXPECT_TRUE(within(prior, planar_pose(3.7, -0.7, 0.5)));
  EXPECT_FALSE(within(prior, planar_pose(3.9, 2, 0.5)));
  EXPECT_FALSE(within(prior, planar_pose(1, -0.9, 0.5)));
  EXPECT_TRUE(within(prior, planar_pose(1, 2, 0.9)));
  EXPECT_FALSE(within(prior, planar_pose(1, 2, 1)));
}

/// A robot's wheels once gave such a covariance, and the search of a window of NaN crashed.
TEST(Within, WhatIsNoVarianceExcludesNothing) {
  for (const double none : {-0.1, -1e-6, std::numeric_limits<double>::quiet_NaN()}) {
    UncertainPose prior{planar_pose(1, 2, 0.5), none * Matrix6::Identity()};
    EXPECT_TRUE(within(prior, planar_pose(1, 2, 0.5 + 3))) << none;
    EXPECT_TRUE(within(prior, planar_pose(1 + CoarseSearchConfig{}.most_xy_m, 2, 0.5))) << none;
  }
}

/// Columns every 3 m: a map that is moved by 3 m, 6 m, … fits nearly as well, and overlaps more.
TEST(DefaultMatcher, StaysWhereTheGuessHasIt) {
  support::Scene colonnade{"colonnade", {}, support::ellipse(30, 2.5, 25, 0.8)};
  colonnade.world.box({0, 0, 0}, {60, 5, 3});
  for (double x = 1.5; x < 60; x += 3)
    colonnade.world.box({x, 0, 0}, {x + 0.6, 0.6, 3}).box({x, 4.4, 0}, {x + 0.6, 5, 3});
  const auto pair = support::two_robots(colonnade, {-0.5, 0.1, 8}, {0, 0.6, 8}, 3);
  const auto a = MapFeatures::build(*pair.a), b = MapFeatures::build(*pair.b);
  ASSERT_TRUE(a && b);
  const DefaultMatcher matcher(*a, *b);
  for (const double x : {-2.0, 0.0, 2.0})
    for (const double y : {-2.0, 2.0}) {
      const UncertainPose guess{SE3(pair.T_a_b.quaternion(), pair.T_a_b.translation() + Eigen::Vector3d(x, y, 0)),
                                default_prior_covariance()};
      Budget budget = Budget::steps(kAmpleSteps);
      const auto found = matcher.match(guess, budget);
      ASSERT_TRUE(found);
      EXPECT_TRUE(within(guess, found->T_a_b.mean)) << x << " " << y;
    }
}

}  // namespace
}  // namespace cairn::matching
