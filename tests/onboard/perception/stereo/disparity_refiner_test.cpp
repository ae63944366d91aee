// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/disparity_refiner.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::stereo {
namespace {

/// A smooth pattern, shifted to the left by `disparity` pixels that grow with the row by `slope`.
cv::Mat pattern(double disparity, double slope) {
  cv::Mat picture(40, 80, CV_8UC1);
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u) {
      const double x = u + disparity + slope * (v - 20);
      picture.at<unsigned char>(v, u) = static_cast<unsigned char>(
          std::lround(128 + 50 * std::sin(0.55 * x) * std::cos(0.3 * v) + 30 * std::sin(0.31 * x + 0.2 * v)));
    }
  return picture;
}

TEST(DisparityRefiner, FindsAFractionOfAPixel) {
  const cv::Mat left = pattern(0, 0);
  for (const double disparity : {7.1, 7.37, 7.5, 7.83}) {
    const cv::Mat right = pattern(disparity, 0);
    const auto found = DisparityRefiner(left, right).refine({40, 20, 7.4, 0, 0});
    ASSERT_TRUE(found) << disparity;
    EXPECT_NEAR(*found, disparity, 0.04);
  }
}

TEST(DisparityRefiner, LeansAsTheSurfaceDoes) {
  const cv::Mat left = pattern(0, 0), right = pattern(7.3, 0.2);
  const DisparityRefiner refiner(left, right);
  const auto leaning = refiner.refine({40, 20, 7.0, 0, 0.2});
  ASSERT_TRUE(leaning);
  EXPECT_NEAR(*leaning, 7.3, 0.05);
}

TEST(DisparityRefiner, SaysNothingWhereNothingCanBeSeen) {
  const cv::Mat flat(40, 80, CV_8UC1, cv::Scalar(90)), left = pattern(0, 0), right = pattern(7.3, 0);
  EXPECT_FALSE(DisparityRefiner(flat, flat).refine({40, 20, 7.0, 0, 0}));
  const DisparityRefiner refiner(left, right);
  EXPECT_FALSE(refiner.refine({1, 20, 7.0, 0, 0}));   // the patch leaves the left picture
  EXPECT_FALSE(refiner.refine({8, 20, 7.0, 0, 0}));   // the right one
  EXPECT_FALSE(refiner.refine({40, 20, 5.0, 0, 0}));  // too far from the truth
  EXPECT_FALSE(refiner.refine({40, 39, 7.0, 0, 0}));
}

TEST(DisparityRefiner, ABrighterRightEyeDoesNotMatter) {
  const cv::Mat left = pattern(0, 0);
  cv::Mat right = pattern(7.3, 0);
  right += 20;
  const auto found = DisparityRefiner(left, right).refine({40, 20, 7.0, 0, 0});
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 7.3, 0.04);
}

}  // namespace
}  // namespace cairn::stereo
