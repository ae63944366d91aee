// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/pose_predictor.hpp"

#include <gtest/gtest.h>

namespace cairn::app {
namespace {

using std::chrono::milliseconds;

/// One metre a second forward, turning to the left.
PoseNews moving() {
  PoseNews news;
  news.point.stamp = Time{milliseconds(1000)};
  news.point.epoch = 3;
  news.point.twist << 1, 0, 0, 0, 0, 0.5;
  odometry::MotionFilter::Uncertainty uncertainty;
  uncertainty.total = uncertainty.local = 1e-4 * odometry::Matrix12::Identity();
  news.filter.reset({.T_odom_base = SE3(), .twist = news.point.twist}, uncertainty);
  news.point.T_odom_base = news.filter.pose();
  news.noise = odometry::MotionNoise::of(1, 1);
  return news;
}

TEST(PosePredictor, GoesOnWithTheTwist) {
  PosePredictor predictor;
  predictor.take(moving());
  const auto pose = predictor.at(Time{milliseconds(1100)});
  ASSERT_TRUE(pose);
  EXPECT_TRUE(pose->predicted);
  EXPECT_EQ(pose->stamp, Time{milliseconds(1100)});
  EXPECT_EQ(pose->epoch, 3U);
  const SE3 expected = SE3::exp(0.1 * moving().point.twist);
  EXPECT_LT((expected.inverse() * pose->T_odom_base.mean).log().norm(), 1e-9);
  EXPECT_EQ(pose->twist, moving().point.twist);
}

TEST(PosePredictor, IsLessCertainTheFartherItLooks) {
  PosePredictor predictor;
  predictor.take(moving());
  double before = moving().point.T_odom_base.covariance.trace();
  for (const int ms : {1010, 1100, 1300, 1500}) {
    const auto pose = predictor.at(Time{milliseconds(ms)});
    ASSERT_TRUE(pose);
    EXPECT_GT(pose->T_odom_base.covariance.trace(), before);
    before = pose->T_odom_base.covariance.trace();
  }
  EXPECT_GT(before, 0.25 * 0.25 / 3);  // a white acceleration of 1 m/s² alone: ½·dt⁴/3 an axis
}

TEST(PosePredictor, SaysNothingBeforeAScanOrLongAfterIt) {
  PosePredictor predictor;
  EXPECT_FALSE(predictor.at(Time{milliseconds(1100)}));
  predictor.take(moving());
  EXPECT_FALSE(predictor.at(Time{milliseconds(1000)}));
  EXPECT_FALSE(predictor.at(Time{milliseconds(1501)}));
}

TEST(PosePredictor, AScansPoseIsItsMessage) {
  TrackPoint point = moving().point;
  point.lost = true;
  point.degenerate_directions = 2;
  const auto message = message_of(point);
  EXPECT_FALSE(message.predicted);
  EXPECT_TRUE(message.lost);
  EXPECT_EQ(message.degenerate_directions, 2);
  EXPECT_EQ(message.stamp, point.stamp);
  EXPECT_EQ(message.T_odom_base.covariance, point.T_odom_base.covariance);
}

}  // namespace
}  // namespace cairn::app
