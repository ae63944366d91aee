// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/wheel_aid.hpp"

#include <gtest/gtest.h>

namespace cairn::odometry {
namespace {

SE3 moved(double x, double yaw) { return SE3::exp((Vector6() << x, 0, 0, 0, 0, yaw).finished()); }

/// Nothing holds x.
Degeneracy open_along_x() {
  Degeneracy d;
  d.count = 1;
  d.undetermined(0, 0) = 1;
  d.keep(0, 0) = 0;
  return d;
}

class WheelAidTest : public ::testing::Test {
 protected:
  /// The wheels roll `motion`, while the base moves by `base` and the scan has `degeneracy`.
  void step(const SE3& motion, const SE3& base, const Degeneracy& degeneracy) {
    roll(motion);
    aid_.followed(wheels_, base, degeneracy);
    wheels_.followed();
  }
  void roll(const SE3& motion) {
    state_.T_odom_base.mean = state_.T_odom_base.mean * motion;
    wheels_.note(&state_);
  }

  DriveState state_;
  WheelBridge wheels_;
  WheelAid aid_;
};

TEST_F(WheelAidTest, SaysNothingWhereScansTellEverything) {
  step({}, {}, open_along_x());
  roll(moved(0.1, 0));
  EXPECT_TRUE(aid_.open_motion(wheels_));
  step({}, {}, {});
  roll(moved(0.1, 0));
  EXPECT_FALSE(aid_.open_motion(wheels_));
}

TEST_F(WheelAidTest, SaysNothingWhileWheelsContradictThemselves) {
  step({}, {}, open_along_x());
  state_.slipping = true;
  roll(moved(0.1, 0));
  EXPECT_FALSE(aid_.open_motion(wheels_));
}

TEST_F(WheelAidTest, FindsTheScaleWhereScansTellEverything) {
  for (int i = 0; i < 200; ++i) step(moved(0.1, 0), moved(0.102, 0), {});
  EXPECT_NEAR(aid_.scale(), 1.02, 0.002);
  step(moved(0.1, 0), moved(0.102, 0), open_along_x());
  roll(moved(0.1, 0));
  const auto open = aid_.open_motion(wheels_);
  ASSERT_TRUE(open);
  EXPECT_NEAR(open->motion[0], 0.102, 3e-4);
}

TEST_F(WheelAidTest, WheelsThatSpinDoNotChangeTheScale) {
  for (int i = 0; i < 200; ++i) step(moved(0.1, 0), moved(0.1, 0), {});
  const double before = aid_.scale();
  for (int i = 0; i < 200; ++i) step(moved(0.5, 0), moved(0.1, 0), {});
  EXPECT_NEAR(aid_.scale(), before, 0.005);
}

TEST_F(WheelAidTest, WheelsWithAScaleFarOffAreNotBelieved) {
  for (int i = 0; i < 60; ++i) step(moved(0.2, 0), moved(0.16, 0), {});
  ASSERT_TRUE(aid_.wrong_scale());
  EXPECT_NEAR(*aid_.wrong_scale(), 0.8, 1e-6);
  step(moved(0.2, 0), moved(0.16, 0), open_along_x());
  roll(moved(0.2, 0));
  EXPECT_FALSE(aid_.open_motion(wheels_)) << "the corridor's axis stays open";
}

TEST_F(WheelAidTest, AScaleOffByATenthIsFoundAtAnySpeed) {
  for (int i = 0; i < 60; ++i) step(moved(0.5, 0), moved(0.44, 0), {});
  EXPECT_FALSE(aid_.wrong_scale());
  EXPECT_NEAR(aid_.scale(), 0.88, 0.005);
}

TEST_F(WheelAidTest, ScansWithoutTheirOwnWayTeachNothing) {
  for (int i = 0; i < 200; ++i) step(moved(0.1, 0), moved(0.12, 0), open_along_x());
  EXPECT_EQ(aid_.scale(), 1);
}

TEST_F(WheelAidTest, WheelsThatTurnOtherwiseThanTheBaseSlip) {
  step({}, {}, {});
  roll(moved(0.1, 0.1));
  EXPECT_TRUE(WheelAid::slipped(wheels_, moved(0.1, 0)));
  EXPECT_FALSE(WheelAid::slipped(wheels_, moved(0.1, 0.07))) << "skid steering always turns less";
}

TEST_F(WheelAidTest, AnotherPlaceAlongTheOpenDirectionIsNotBelieved) {
  step({}, {}, open_along_x());
  roll(moved(0.1, 0));
  const auto open = aid_.open_motion(wheels_);
  ASSERT_TRUE(open);
  EXPECT_TRUE(WheelAid::agrees(*open, moved(0.15, 0.3))) << "the heading is not open";
  EXPECT_FALSE(WheelAid::agrees(*open, moved(1.1, 0)));
}

}  // namespace
}  // namespace cairn::odometry
