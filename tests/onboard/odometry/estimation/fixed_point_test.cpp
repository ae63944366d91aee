// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/fixed_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace cairn::odometry {
namespace {

const Vector6 kAnswer = (Vector6() << 1.2, -0.3, 0.1, 0.02, -0.04, -0.6).finished();

/// Errors come back `swing` times as large, turned by 6° about z.
Vector6 led_to(const Vector6& x, double swing) {
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Vector6 g = kAnswer;
  for (const int part : {0, 3}) g.segment<3>(part) += swing * turned * (x - kAnswer).segment<3>(part);
  return g;
}

double error_after(int rounds, double swing) {
  FixedPoint search;
  Vector6 x = Vector6::Zero();
  for (int i = 0; i < rounds; ++i) x = search.next(x, led_to(x, swing));
  return (x - kAnswer).norm();
}

TEST(FixedPoint, FindsWhatRepeatingSwingsAwayFrom) {
  // The first scans of aggressive and hand-held drives swung by 1.0 to 2.3.
  for (const double swing : {-1.0, -1.7, -2.3}) {
    EXPECT_LT(error_after(2, swing), 0.15 * kAnswer.norm()) << swing;
    EXPECT_LT(error_after(8, swing), 0.01 * kAnswer.norm()) << swing;
  }
}

TEST(FixedPoint, GoesOnWhereRepeatingIsEnough) {
  for (const double swing : {-0.5, 0.0, 0.3}) EXPECT_LT(error_after(8, swing), 0.01 * kAnswer.norm()) << swing;
}

TEST(FixedPoint, StaysAtTheAnswerAndBeginsWithWhatItIsGiven) {
  FixedPoint search;
  EXPECT_EQ(search.next(Vector6::Zero(), kAnswer), kAnswer);
  EXPECT_EQ(search.next(kAnswer, kAnswer), kAnswer);
  EXPECT_EQ(search.next(kAnswer, kAnswer), kAnswer) << "nothing has changed: no division by zero";
}

}  // namespace
}  // namespace cairn::odometry
