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
    EXPECT_FALSE(check.contradicts(SE3::exp(0.5 * kRevolution_s * (before + after)), kRevolution_s, before, after));
    before = after;
  }
}

TEST(TwistCheck, PosesThatStandWhileTheTwistTurnsContradictItWithinAFewScans) {
  TwistCheck check;
  const Vector6 turning = 1.5 * Vector6::Unit(5);
  int scans = 1;
  while (!check.contradicts({}, kRevolution_s, turning, turning)) ASSERT_LT(++scans, 5);
  EXPECT_GE(scans, 2) << "one scan says nothing";
  check.reset();
  EXPECT_FALSE(check.contradicts({}, kRevolution_s, turning, turning));
}

}  // namespace
}  // namespace cairn::odometry
