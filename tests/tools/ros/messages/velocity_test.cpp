// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/velocity.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tools/ros/messages/header.hpp"

namespace cairn::ros {
namespace {

using std::chrono::milliseconds;
constexpr Duration kClock = std::chrono::seconds(1'700'000'000);

TwistStamped stamped(Duration utc) {
  TwistStamped twist{};
  twist.header.stamp = stamp_of(Time{}, utc);
  twist.twist.linear.x = 0.25;
  return twist;
}

TEST(RosVelocity, IsForwardAndAboutZ) {
  Twist twist{};
  twist.linear.x = 0.5;
  twist.angular.z = -0.25;
  Velocity velocity;
  EXPECT_EQ(judge(twist, velocity), Verdict::kTake);
  EXPECT_EQ(velocity.v, 0.5);
  EXPECT_EQ(velocity.w, -0.25);
}

TEST(RosVelocity, WhatWheelsCannotDoIsRefused) {
  Velocity velocity{.v = 7, .w = 7};
  for (int i = 0; i < 4; ++i) {
    Twist twist{};
    double* const fields[] = {&twist.linear.y, &twist.linear.z, &twist.angular.x, &twist.angular.y};
    *fields[i] = 0.1;
    EXPECT_EQ(judge(twist, velocity), Verdict::kNotPossible);
  }
  Twist twist{};
  twist.angular.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge(twist, velocity), Verdict::kNotFinite);
  twist.angular.y = 0;
  twist.linear.x = std::numeric_limits<double>::infinity();
  EXPECT_EQ(judge(twist, velocity), Verdict::kNotFinite);
  EXPECT_EQ(velocity.v, 7) << "as before";
}

TEST(RosVelocity, AStampMustBeFresh) {
  Velocity velocity;
  EXPECT_EQ(judge(stamped(kClock - milliseconds(499)), kClock, velocity), Verdict::kTake);
  EXPECT_EQ(velocity.v, 0.25);
  EXPECT_EQ(judge(stamped(kClock - milliseconds(500)), kClock, velocity), Verdict::kTooOld);
  EXPECT_EQ(judge(stamped(kClock + milliseconds(500)), kClock, velocity), Verdict::kTooOld);
  EXPECT_EQ(judge(TwistStamped{}, kClock, velocity), Verdict::kTooOld) << "no stamp at all";
}

TEST(RosVelocity, EveryVerdictHasWords) {
  for (const Verdict verdict : {Verdict::kTake, Verdict::kNotFinite, Verdict::kNotPossible, Verdict::kTooOld})
    EXPECT_FALSE(to_string(verdict).empty());
}

}  // namespace
}  // namespace cairn::ros
