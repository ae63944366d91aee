// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/pair_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "onboard/perception/calibration/camera_calibration.hpp"
#include "tests/onboard/perception/calibration/board_scans.hpp"

namespace cairn::calibration {
namespace {

using cameras::CameraModel;
using test::kLargeBoard;

/// A Lepton: 160×120 pixels, 57° wide.
cameras::CameraParameters thermal_camera() {
  return {.width = 160,
          .height = 120,
          .fx = 147,
          .fy = 147,
          .cx = 79.5,
          .cy = 59.5,
          .distortion = {.model = cameras::DistortionModel::kRadTan, .k = {-0.1, 0.02, 0, 0}}};
}

/// T_camera_thermal, body axes.
SE3 true_pair() { return SE3::from_xyz_rpy((Vector6() << 0.02, -0.08, 0.05, 0.02, -0.03, 0.015).finished()); }

struct Noise {
  double camera_px = 0.1, thermal_px = 0.1;
};

std::vector<PairView> random_views(std::size_t count, const test::Holding& how, const Noise& noise, unsigned seed) {
  std::mt19937 random(seed);
  const auto camera = *CameraModel::create(test::robot_camera()), thermal = *CameraModel::create(thermal_camera());
  const SE3 C = cameras::T_camera_optical(), T_camera_thermal = C.inverse() * true_pair() * C;
  std::vector<PairView> views;
  while (views.size() < count) {
    const SE3 T = test::random_pose(thermal, kLargeBoard, how, random);
    const auto second = test::seen_corners(thermal, kLargeBoard, T, noise.thermal_px, random);
    const auto first = test::seen_corners(camera, kLargeBoard, T_camera_thermal * T, noise.camera_px, random);
    if (first && second) views.push_back({*first, *second});
  }
  return views;
}

/// The largest distance in the thermal picture between where a place is seen and where the calibration has it, of
/// places 2 to 20 m away all over the picture, pixels.
double worst_pixel(const SE3& T_camera_thermal, const CameraModel& as_calibrated) {
  const auto thermal = *CameraModel::create(thermal_camera());
  const SE3 C = cameras::T_camera_optical();
  double worst = 0;
  for (const double depth : {2.0, 5.0, 20.0})
    for (int u = 0; u < 160; u += 10)
      for (int v = 0; v < 120; v += 10) {
        const Eigen::Vector3d place = *thermal.unproject({u, v}) * depth;
        const SE3 T = (T_camera_thermal * C).inverse() * true_pair() * C;
        if (const auto pixel = as_calibrated.project(T * place))
          worst = std::max(worst, (*pixel - Eigen::Vector2d(u, v)).norm());
      }
  return worst;
}

Result<PairCalibration> calibrate(const std::vector<PairView>& views) {
  return calibrate_pair(kLargeBoard, views, *CameraModel::create(test::robot_camera()),
                        *CameraModel::create(thermal_camera()));
}

constexpr test::Holding kGood{.nearest = 14, .farthest = 32};

void expect_pairs(unsigned seeds) {
  int inside = 0, all = 0;
  double worst = 0;
  for (unsigned seed = 0; seed < seeds; ++seed, all += 6) {
    const auto c = calibrate(random_views(20, kGood, {}, 700 + seed));
    ASSERT_TRUE(c) << to_string(c.error());
    EXPECT_TRUE(c->faults.empty()) << c->faults.front();
    EXPECT_EQ(c->used.size(), 20U);
    worst = std::max(worst, worst_pixel(c->T_first_second, *CameraModel::create(thermal_camera())));
    const Vector6 apart = c->T_first_second.xyz_rpy() - true_pair().xyz_rpy();
    for (Eigen::Index i = 0; i < 6; ++i) inside += std::abs(apart[i]) <= 2 * c->deviations[i];
    EXPECT_NEAR(c->corner_rms_px[0], 0.1, 0.02);
    EXPECT_NEAR(c->corner_rms_px[1], 0.1, 0.02);
  }
  std::cout << "worst: " << worst << " px; within 2 sigma: " << inside << " of " << all << '\n';
  EXPECT_LT(worst, 0.3);
  EXPECT_GE(inside, 0.85 * all);
}

TEST(PairCalibration, MeetsThermalPixelsFromTwentyViews) { expect_pairs(3); }
TEST(FullPairCalibration, MeetsThermalPixelsHonestly) { expect_pairs(60); }

/// A camera as calibrated from 60 good views.
CameraModel as_calibrated(const cameras::CameraParameters& truth, unsigned seed) {
  std::mt19937 random(seed);
  const auto views =
      test::random_views(*CameraModel::create(truth), kLargeBoard, 60, 0.1, {.nearest = 9, .farthest = 20}, random);
  const auto c = calibrate_camera(kLargeBoard, views, truth.width, truth.height, cameras::DistortionModel::kRadTan);
  EXPECT_TRUE(c && c->faults.empty());
  return *CameraModel::create(c->eye.parameters);
}

/// As a user has it: the intrinsics are of other recordings of a board.
void expect_pairs_with_calibrated_intrinsics(unsigned seeds, double most_px) {
  std::vector<double> worst;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const CameraModel camera = as_calibrated(test::robot_camera(), 1000 + seed),
                      thermal = as_calibrated(thermal_camera(), 2000 + seed);
    const auto c = calibrate_pair(kLargeBoard, random_views(30, kGood, {}, 800 + seed), camera, thermal);
    ASSERT_TRUE(c) << to_string(c.error());
    worst.push_back(worst_pixel(c->T_first_second, thermal));
  }
  std::sort(worst.begin(), worst.end());
  std::cout << "worst pixel of " << seeds << " sets: median " << worst[worst.size() / 2] << ", at most " << worst.back()
            << " px\n";
  EXPECT_LT(worst[worst.size() / 2], most_px);
}

TEST(PairCalibration, MeetsThermalPixelsWithCalibratedIntrinsics) { expect_pairs_with_calibrated_intrinsics(1, 0.5); }
TEST(FullPairCalibration, MeetsThermalPixelsWithCalibratedIntrinsics) {
  expect_pairs_with_calibrated_intrinsics(20, 0.3);
}

TEST(PairCalibration, TheNoisierCameraCountsLess) {
  const auto c = calibrate(random_views(20, kGood, {.camera_px = 0.05, .thermal_px = 0.4}, 900));
  ASSERT_TRUE(c) << to_string(c.error());
  EXPECT_NEAR(c->corner_rms_px[0], 0.05, 0.01);
  EXPECT_NEAR(c->corner_rms_px[1], 0.4, 0.05);
}

TEST(PairCalibration, AViewThatWasMovedBetweenThePicturesIsDropped) {
  auto views = random_views(18, kGood, {}, 901);
  for (Eigen::Vector2d& p : views[7].second) p += Eigen::Vector2d(4, 2);
  const auto c = calibrate(views);
  ASSERT_TRUE(c) << to_string(c.error());
  EXPECT_EQ(c->dropped, std::vector<std::size_t>{7});
  EXPECT_LT(worst_pixel(c->T_first_second, *CameraModel::create(thermal_camera())), 0.4);
}

TEST(PairCalibration, FarBoardsAreRefused) {
  const auto c = calibrate(
      random_views(12, {.nearest = 60, .farthest = 70, .tilt = 0.05}, {.camera_px = 0.5, .thermal_px = 1.5}, 902));
  ASSERT_TRUE(c) << to_string(c.error());
  EXPECT_FALSE(c->faults.empty());
}

TEST(PairCalibration, FewViewsAreAnError) {
  const auto c = calibrate(random_views(kLeastPoses - 1, kGood, {}, 903));
  ASSERT_FALSE(c);
  EXPECT_EQ(c.error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace cairn::calibration
