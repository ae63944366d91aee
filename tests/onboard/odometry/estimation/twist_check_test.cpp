// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/twist_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::odometry {
namespace {

constexpr double kRevolution_s = 0.1;

TEST(TwistCheck, PosesThatMoveAsTheTwistSaysAgreeWithIt) {
  TwistCheck check;
  Vector6 before = Vector6::Zero();
  for (int i = 0; i < 100; ++i) {  // jerks to both sides, as bumps and onsets make them
    Vector6 after = 1.5 * std::sin(2.1 * i) * Vector6::Unit(5) + 2 * std::sin(1.3 * i) * Vector6::Unit(0);
    check.note(SE3::exp(0.5 * kRevolution_s * (before + after)), kRevolution_s, before, after);
    EXPECT_FALSE(check.contradicted());
    EXPECT_TRUE(check.lacking().isZero());
    before = after;
  }
}

TEST(TwistCheck, PosesThatStandWhileTheTwistTurnsContradictItWithinAFewScans) {
  TwistCheck check;
  const Vector6 turning = 1.5 * Vector6::Unit(5);
  int scans = 0;
  do {
    check.note({}, kRevolution_s, turning, turning);
    ASSERT_LT(++scans, 5);
  } while (!check.contradicted());
  EXPECT_GE(scans, 2) << "one scan says nothing";
  check.reset();
  check.note({}, kRevolution_s, turning, turning);
  EXPECT_FALSE(check.contradicted());
}

TEST(TwistCheck, ASmallContradictionIsFoundOutWithinSeconds) {
  for (const Vector6& twist : {Vector6(0.1 * Vector6::Unit(5)), Vector6(0.25 * Vector6::Unit(5)),
                               Vector6(0.3 * Vector6::Unit(1)), Vector6(0.7 * Vector6::Unit(1))}) {
    TwistCheck check;
    int scans = 0;
    do {
      check.note({}, kRevolution_s, twist, twist);
      ASSERT_LT(++scans, 30);
    } while (check.lacking().isZero());
    EXPECT_GE(scans, 3);
    EXPECT_LT((check.lacking() + twist).norm(), 1e-9) << "the poses stand";
    for (int i = 0; i < 20; ++i) {                            // a map that goes on saying the same
      check.note({}, kRevolution_s, Vector6::Zero(), twist);  // as it was mended, and as it comes
      EXPECT_LT((check.lacking() + twist).norm(), 1e-9) << i;
    }
    EXPECT_EQ(check.map_confirms_wrong_twist(), twist.norm() > (twist[5] > 0 ? 0.2 : 0.5));
    for (int i = 0; i < 60; ++i) {  // and one that does not
      check.note({}, kRevolution_s, check.lacking(), Vector6::Zero());
      static_cast<void>(check.lacking());
    }
    EXPECT_TRUE(check.lacking().isZero());
    EXPECT_FALSE(check.map_confirms_wrong_twist());
  }
}

TEST(TwistCheck, WhatHappensInAGapIsNoLongContradiction) {
  TwistCheck check;
  for (int i = 0; i < 30; ++i) check.note({}, 0.5, 0.1 * Vector6::Unit(5), 0.1 * Vector6::Unit(5));
  EXPECT_TRUE(check.lacking().isZero());
}

}  // namespace
}  // namespace cairn::odometry
