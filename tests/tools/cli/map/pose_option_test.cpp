// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/pose_option.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::vector<double>& numbers) {
  const auto pose = pose_from_option("--pose", numbers);
  EXPECT_FALSE(pose);
  return pose ? "" : to_string(pose.error());
}

TEST(PoseOption, IsMetresAndRadians) {
  const auto pose = pose_from_option("--pose", {1, -2, 3, 0, 0, std::numbers::pi / 2});
  ASSERT_TRUE(pose);
  EXPECT_NEAR((*pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, -1, 3)).norm(), 0, 1e-12);
  EXPECT_TRUE(pose_from_option("--pose", {0, 0, 0, 0, 0, -6.28})) << "nearly a whole turn";
}

TEST(PoseOption, DegreesAreRefusedWithWhatTheyAreInRadians) {
  EXPECT_THAT(refusal({0, 0, 0, 0, 0, 90}), HasSubstr("--pose: angles are in radians, up to a full turn: yaw is 90; if "
                                                      "that is in degrees, write 1.5708"));
  EXPECT_THAT(refusal({0, 0, 0, -180, 0, 0}), HasSubstr("roll is -180"));
}

TEST(PoseOption, WhatNoMapCanBeAtIsRefused) {
  EXPECT_THAT(refusal({0, 1e9, 0, 0, 0, 0}), HasSubstr("y is 1e+09 m"));
  EXPECT_THAT(refusal({0, 0, std::numeric_limits<double>::quiet_NaN(), 0, 0, 0}), HasSubstr("z is nan"));
  EXPECT_THAT(refusal({0, std::numeric_limits<double>::infinity(), 0, 0, 0, 0}), HasSubstr("finite"));
  EXPECT_THAT(refusal({1, 2, 3}), HasSubstr("six numbers"));
}

}  // namespace
}  // namespace cairn::cli
