// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/camera_calibration.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/onboard/perception/calibration/boards.hpp"

namespace cairn::calibration {
namespace {

using cameras::CameraModel;
using cameras::CameraParameters;
using cameras::DistortionModel;
using test::Holding;

using test::kBoard;

Eigen::Matrix<double, kEyeUnknowns, 1> numbers(const CameraParameters& p) {
  const auto& k = p.distortion.k;
  return (Eigen::Matrix<double, kEyeUnknowns, 1>() << p.fx, p.fy, p.cx, p.cy, k[0], k[1], k[2], k[3]).finished();
}

Result<CameraCalibration> calibrate(const CameraParameters& truth, std::size_t count, unsigned seed,
                                    const Holding& how = {}, double noise_px = 0.1) {
  std::mt19937 random(seed);
  const auto camera = *CameraModel::create(truth);
  const auto views = test::random_views(camera, kBoard, count, noise_px, how, random);
  return calibrate_camera(kBoard, views, truth.width, truth.height, truth.distortion.model);
}

/// How many of the numbers are within `sigmas` of the truth.
int within(const EyeEstimate& eye, const CameraParameters& truth, double sigmas) {
  const Eigen::Matrix<double, kEyeUnknowns, 1> error = numbers(eye.parameters) - numbers(truth);
  int inside = 0;
  for (Eigen::Index i = 0; i < kEyeUnknowns; ++i) inside += std::abs(error[i]) <= sigmas * eye.deviation(i);
  return inside;
}

void expect_honest(const CameraParameters& truth, unsigned seeds) {
  int inside = 0, all = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const auto c = calibrate(truth, 20, 100 + seed);
    ASSERT_TRUE(c) << to_string(c.error());
    EXPECT_TRUE(c->faults.empty()) << seed << ": " << c->faults.front();
    EXPECT_NEAR(c->eye.rms_px, 0.1, 0.02);
    inside += within(c->eye, truth, 2);
    all += kEyeUnknowns;
    EXPECT_GE(within(c->eye, truth, 4), kEyeUnknowns) << seed;
  }
  std::cout << "within 2 sigma: " << inside << " of " << all << '\n';
  EXPECT_GE(inside, 0.9 * all);
}

TEST(CameraCalibration, FindsAPinholeCamera) {
  const CameraParameters truth = test::small_camera();
  const auto c = calibrate(truth, 30, 1);
  ASSERT_TRUE(c) << to_string(c.error());
  EXPECT_TRUE(c->faults.empty());
  EXPECT_EQ(c->views.size(), 30U);
  EXPECT_NEAR(c->eye.parameters.fx, truth.fx, 0.5);
  EXPECT_EQ(within(c->eye, truth, 3), kEyeUnknowns);
}

TEST(CameraCalibration, FindsAFisheye) {
  const CameraParameters truth = test::fisheye_camera();
  const auto c = calibrate(truth, 30, 2);
  ASSERT_TRUE(c) << to_string(c.error());
  EXPECT_TRUE(c->faults.empty()) << c->faults.front();
  EXPECT_NEAR(c->eye.parameters.fx, truth.fx, 0.5);
  EXPECT_EQ(within(c->eye, truth, 3), kEyeUnknowns);
}

TEST(CameraCalibration, CovarianceIsHonest) { expect_honest(test::small_camera(), 8); }
TEST(FullCameraCalibration, CovarianceIsHonest) { expect_honest(test::small_camera(), 100); }
TEST(FullCameraCalibration, CovarianceOfAFisheyeIsHonest) { expect_honest(test::fisheye_camera(), 60); }

TEST(CameraCalibration, AViewThatDoesNotFitIsDropped) {
  std::mt19937 random(4);
  const auto camera = *CameraModel::create(test::small_camera());
  auto views = test::random_views(camera, kBoard, 25, 0.1, {}, random);
  for (Eigen::Vector2d& p : views[7]) p += Eigen::Vector2d(3 * std::sin(p.x() * 0.1), 2 * std::cos(p.x() * 0.2));
  const auto c = calibrate_camera(kBoard, views, 336, 240, DistortionModel::kRadTan);
  ASSERT_TRUE(c) << to_string(c.error());
  EXPECT_EQ(c->dropped, (std::vector<std::size_t>{7}));
  EXPECT_LT(c->eye.rms_px, 0.13);
}

/// Poor sets of views: each is refused, or its numbers are within their stated deviations.
TEST(CameraCalibration, PoorViewsAreRefusedOrHonest) {
  const CameraParameters truth = test::small_camera();
  const Holding frontal{.tilt = 0.02}, corner{.nearest = 14, .farthest = 20, .most_u = 0.35, .most_v = 0.35},
      far{.nearest = 40, .farthest = 60}, leaning{.nearest = 10, .farthest = 12, .tilt = 0.1};
  int refused = 0, sets = 0, inside = 0, numbers_judged = 0;
  for (const Holding& how : {frontal, corner, far, leaning})
    for (unsigned seed = 0; seed < 5; ++seed, ++sets) {
      const auto c = calibrate(truth, 8 + seed, 200 + seed, how, 0.2);
      if (!c || !c->faults.empty()) {
        ++refused;
        continue;
      }
      inside += within(c->eye, truth, 2);
      numbers_judged += kEyeUnknowns;
      EXPECT_GE(within(c->eye, truth, 4), kEyeUnknowns);
    }
  std::cout << refused << " poor sets refused; of the others within 2 sigma: " << inside << " of " << numbers_judged
            << '\n';
  EXPECT_EQ(sets, 20);
  EXPECT_GE(refused, 10);
  EXPECT_GE(inside, 0.9 * numbers_judged);
}

TEST(CameraCalibration, FrontalBoardsDoNotTellTheFocalLength) {
  const auto c = calibrate(test::small_camera(), 20, 9, {.tilt = 0});
  ASSERT_TRUE(c) << to_string(c.error());
  ASSERT_FALSE(c->faults.empty());
  const auto missing = c->coverage.missing();
  EXPECT_TRUE(std::any_of(missing.begin(), missing.end(), [](const auto& m) { return m.find("tilted") < m.size(); }));
}

TEST(CameraCalibration, FewViewsAreAnError) {
  const auto c = calibrate(test::small_camera(), kLeastViews - 1, 1);
  ASSERT_FALSE(c);
  EXPECT_EQ(c.error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace cairn::calibration
