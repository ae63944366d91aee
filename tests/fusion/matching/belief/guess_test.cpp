// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/guess.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cairn::matching {
namespace {

UncertainPose guess_of(double sigma_m, double sigma_rad) {
  UncertainPose guess{SE3::from_xyz_rpy((Vector6() << 3, -2, 0.5, 0, 0, 2).finished()), Matrix6::Identity()};
  guess.covariance.topLeftCorner<3, 3>() *= sigma_m * sigma_m;
  guess.covariance.bottomRightCorner<3, 3>() *= sigma_rad * sigma_rad;
  return guess;
}

TEST(Guess, NinetyNineOfAHundredOfWhatItSaysAgree) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const UncertainPose guess = guess_of(0.5, 0.05);
  int agree = 0;
  for (int i = 0; i < 4000; ++i) {
    Vector6 xi;
    for (double& x : xi) x = normal(random);
    xi.head<3>() *= 0.5;
    xi.tail<3>() *= 0.05;
    agree += agrees(guess, guess.mean * SE3::exp(xi)) ? 1 : 0;
  }
  EXPECT_NEAR(agree / 4000.0, 0.99, 0.006);
}

TEST(Guess, AHeadingThatIsNotKnownSpeaksAgainstNoPlace) {
  UncertainPose guess = guess_of(0.5, 3.2);
  for (const double yaw : {-3.0, -1.0, 0.0, 1.0, 3.0}) {
    SE3 turned = guess.mean * SE3::from_xyz_rpy((Vector6() << 0.5, 0.5, 0, 0, 0, yaw).finished());
    EXPECT_TRUE(agrees(guess, turned)) << yaw;
  }
  const SE3 away = guess.mean * SE3::from_xyz_rpy((Vector6() << 5, 0, 0, 0, 0, 0).finished());
  EXPECT_FALSE(agrees(guess, away));
}

TEST(Guess, ChanceGrowsWithWhatIsNotKnown) {
  double last = 0;
  for (const double sigma_m : {0.1, 0.3, 1.0, 3.0, 10.0}) {
    const double chance = chance_agreement(guess_of(sigma_m, 0.05));
    EXPECT_GT(chance, last);
    EXPECT_LE(chance, 1);
    EXPECT_LT(chance, chance_agreement(guess_of(sigma_m, 3.1)));
    last = chance;
  }
}

TEST(Guess, OneWithoutBoundsIsNotWorthFollowing) {
  EXPECT_TRUE(worth_following(guess_of(4, 0.1)));  // GPS, of both
  EXPECT_FALSE(worth_following(guess_of(10, 0.1)));
}

}  // namespace
}  // namespace cairn::matching
