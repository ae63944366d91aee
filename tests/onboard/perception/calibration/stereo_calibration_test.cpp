// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/stereo_calibration.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/onboard/perception/calibration/boards.hpp"

namespace cairn::calibration {
namespace {

using cameras::CameraModel;
using cameras::DistortionModel;
using test::kBoard;

const SE3 kRightLeft = SE3::from_xyz_rpy((Vector6() << -0.12, 0.001, -0.002, 0.01, -0.008, 0.004).finished());

struct Pairs {
  std::vector<Corners> left, right;
};

Pairs random_pairs(std::size_t count, double noise_px, const test::Holding& how, unsigned seed) {
  std::mt19937 random(seed);
  const auto camera = *CameraModel::create(test::small_camera());
  Pairs pairs;
  while (pairs.left.size() < count) {
    const SE3 T = test::random_pose(camera, kBoard, how, random);
    const auto left = test::seen_corners(camera, kBoard, T, noise_px, random);
    const auto right = test::seen_corners(camera, kBoard, kRightLeft * T, noise_px, random);
    if (!left || !right) continue;
    pairs.left.push_back(*left);
    pairs.right.push_back(*right);
  }
  return pairs;
}

TEST(StereoCalibration, FindsBaselineAndRotationHonestly) {
  int inside = 0, all = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Pairs pairs = random_pairs(25, 0.1, {.nearest = 8, .farthest = 18}, 300 + seed);
    const auto s = calibrate_stereo(kBoard, pairs.left, pairs.right, 336, 240, DistortionModel::kRadTan);
    ASSERT_TRUE(s) << to_string(s.error());
    EXPECT_TRUE(s->faults.empty()) << s->faults.front();
    EXPECT_NEAR(s->baseline_m, kRightLeft.translation().norm(), 4 * s->baseline_deviation_m);
    EXPECT_NEAR(s->baseline_m, kRightLeft.translation().norm(), 5e-4);
    const Vector6 error = (s->T_right_left.inverse() * kRightLeft).log();
    EXPECT_LT(error.tail<3>().norm() * 180 / std::numbers::pi, 0.1);
    EXPECT_LT(s->epipolar_rms_px, 0.16);
    EXPECT_GT(s->epipolar_rms_px, 0.08) << "the noise of two corners";
    for (Eigen::Index i = 0; i < 6; ++i, ++all) inside += std::abs(error[i]) <= 2 * std::sqrt(s->covariance(i, i));
  }
  ::testing::Test::RecordProperty("stereo_within_two_sigma", inside);
  EXPECT_GE(inside, 0.85 * all);
}

TEST(StereoCalibration, PoorViewsOfOneEyeRefuseBoth) {
  const Pairs pairs = random_pairs(12, 0.1, {.nearest = 14, .farthest = 18, .tilt = 0.02}, 5);
  const auto s = calibrate_stereo(kBoard, pairs.left, pairs.right, 336, 240, DistortionModel::kRadTan);
  ASSERT_TRUE(s) << to_string(s.error());
  EXPECT_FALSE(s->faults.empty());
}

}  // namespace
}  // namespace cairn::calibration
