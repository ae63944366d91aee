// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_place.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::peers {
namespace {

UncertainPose pose(double x, double y, double yaw, double sigma) {
  return {SE3::from_xyz_rpy((Vector6() << x, y, 3, 0, 0, yaw).finished()), Matrix6::Identity() * sigma * sigma};
}

TEST(OwnPlace, IsThePoseInOdom) {
  const auto place = place_of(pose(1, -2, 0.7, 0.1));
  ASSERT_TRUE(place);
  EXPECT_EQ(place->position_m, (std::array<double, 3>{1, -2, 3}));
  EXPECT_NEAR(place->yaw_rad, 0.7, 1e-12);
  EXPECT_NEAR(place->sigma_m, 0.1, 1e-12);
  EXPECT_NEAR(place->sigma_rad, 0.1, 1e-12);
}

TEST(OwnPlace, TheLargestDeviationCountsAndIsBounded) {
  UncertainPose T = pose(0, 0, 0, 0.1);
  T.covariance(1, 1) = 4;
  T.covariance(5, 5) = std::numeric_limits<double>::infinity();
  T.covariance(0, 0) = -1;  // rounding
  const auto place = place_of(T);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->sigma_m, 2);
  EXPECT_EQ(place->sigma_rad, 1e6);
}

TEST(OwnPlace, WhatPeersWouldRefuseIsNone) {
  EXPECT_FALSE(place_of(pose(2e6, 0, 0, 0.1)));
  EXPECT_FALSE(place_of(pose(0, std::numeric_limits<double>::quiet_NaN(), 0, 0.1)));
}

}  // namespace
}  // namespace cairn::peers
