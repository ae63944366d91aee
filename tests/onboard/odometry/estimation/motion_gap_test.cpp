// SPDX-License-Identifier: Apache-2.0
// What the filter does about a twist that its poses do not show.
#include <gtest/gtest.h>

#include "onboard/odometry/estimation/motion_filter.hpp"

namespace cairn::odometry {
namespace {

constexpr double kStep = 0.1;
const MotionNoise kFree = MotionNoise::of(3.0, 2.0);

/// Ends each step at `x`, whatever was measured: what a map would say that confirms every twist.
void believe(MotionFilter& filter, const MotionState& x) {
  NormalEquations equations;
  equations.aa = equations.ttaa = 1e4 * Matrix6::Identity();
  filter.predict(kStep, kFree);
  filter.update(x, {equations, {}, 1}, Matrix6::Zero());
  filter.follow_motion();
}

TEST(MotionGap, ATwistThatThePosesDoNotShowIsCorrected) {
  const Vector6 forward = Vector6::Unit(0), sideways = 0.3 * Vector6::Unit(1);
  MotionFilter filter;
  MotionState x{{}, forward + sideways};
  filter.reset(x, {Matrix12::Identity(), Matrix12::Identity()});
  for (int i = 0; i < 50; ++i) {
    x.T_odom_base = x.T_odom_base * SE3::exp(kStep * forward);
    believe(filter, x);
  }
  filter.predict(kStep, kFree);
  const Vector6 correction = filter.state().twist - x.twist;
  EXPECT_LT((correction + 0.4 * sideways).norm(), 1e-3) << correction.transpose();
  filter.predict(kStep, kFree);
  EXPECT_LT((filter.state().twist - x.twist - correction).norm(), 1e-12) << "once for each scan that fitted";
}

TEST(MotionGap, AnAccelerationIsNoReasonToCorrectTheTwist) {
  const Vector6 acceleration = (Vector6() << 1, -0.5, 0.2, 0.3, -0.4, 0.8).finished();
  MotionFilter filter;
  MotionState x{SE3::exp(-acceleration), (Vector6() << 0.9, 0.1, 0, -0.1, 0.2, -0.7).finished()};
  filter.reset(x, {Matrix12::Identity(), Matrix12::Identity()});
  for (int i = 0; i < 20; ++i) {
    const Vector6 mean = x.twist + 0.5 * kStep * acceleration;
    x = {x.T_odom_base * SE3::exp(kStep * mean), x.twist + kStep * acceleration};
    believe(filter, x);
  }
  filter.predict(kStep, kFree);
  EXPECT_LT((filter.state().twist - x.twist).norm(), 1e-9);
}

TEST(MotionGap, ANewMapKnowsOfNoGap) {
  MotionFilter filter;
  const MotionState x{{}, Vector6::Unit(1)};
  filter.reset(x, {Matrix12::Identity(), Matrix12::Identity()});
  for (int i = 0; i < 5; ++i) believe(filter, x);
  filter.forget_gap();
  filter.predict(kStep, kFree);
  EXPECT_EQ(filter.state().twist, x.twist);
}

}  // namespace
}  // namespace cairn::odometry
