// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/disparity_refiner.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::stereo {
namespace {

double brightness(double x, int row) {
  return 128 + 50 * std::sin(0.55 * x) * std::cos(0.3 * row) + 30 * std::sin(0.31 * x + 0.2 * row);
}

/// A smooth pattern in the right eye: `disparity` pixels to the left at the left eye's pixel 40, 20. That grows by a
/// slope with the left eye's column, and by another with the row. Of zeros: the left eye.
cv::Mat pattern(double disparity, double slope_x, double slope_y) {
  cv::Mat picture(40, 80, CV_8UC1);
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u) {
      const double left = (u + disparity + slope_y * (v - 20) - slope_x * 40) / (1 - slope_x);
      picture.at<unsigned char>(v, u) = static_cast<unsigned char>(std::lround(brightness(left, v)));
    }
  return picture;
}

TEST(DisparityRefiner, FindsAFractionOfAPixel) {
  const cv::Mat left = pattern(0, 0, 0);
  for (const double disparity : {7.1, 7.37, 7.5, 7.83}) {
    const cv::Mat right = pattern(disparity, 0, 0);
    const auto found = DisparityRefiner(left, right).refine({40, 20, 7.4, 0, 0});
    ASSERT_TRUE(found) << disparity;
    EXPECT_NEAR(*found, disparity, 0.04);
  }
}

TEST(DisparityRefiner, LeansAsTheSurfaceDoes) {
  const cv::Mat left = pattern(0, 0, 0), right = pattern(7.3, 0, 0.2);
  const DisparityRefiner refiner(left, right);
  const auto leaning = refiner.refine({40, 20, 7.0, 0, 0.2});
  ASSERT_TRUE(leaning);
  EXPECT_NEAR(*leaning, 7.3, 0.05);
}

TEST(DisparityRefiner, LeansAsAWallDoesAlongTheRow) {
  const cv::Mat left = pattern(0, 0, 0);
  for (const double slope : {-0.3, 0.3}) {
    const cv::Mat right = pattern(7.3, slope, 0);
    const auto leaning = DisparityRefiner(left, right).refine({40, 20, 6.8, slope, 0});
    ASSERT_TRUE(leaning) << slope;
    EXPECT_NEAR(*leaning, 7.3, 0.05) << slope;
  }
}

TEST(DisparityRefiner, ReachesTheEdgesOfBothPictures) {
  const cv::Mat left = pattern(0, 0, 0), right = pattern(7.3, 0, 0);
  const DisparityRefiner refiner(left, right);
  for (const DisparityStart& edge :
       {DisparityStart{12, 20, 7.1, 0, 0}, {75, 20, 7.1, 0, 0}, {40, 3, 7.1, 0, 0}, {40, 36, 7.1, 0, 0}}) {
    const auto found = refiner.refine(edge);
    ASSERT_TRUE(found) << edge.x << ", " << edge.y;
    EXPECT_NEAR(*found, 7.3, 0.05) << edge.x << ", " << edge.y;
  }
}

TEST(DisparityRefiner, SaysNothingWhereNothingCanBeSeen) {
  const cv::Mat flat(40, 80, CV_8UC1, cv::Scalar(90)), left = pattern(0, 0, 0), right = pattern(7.3, 0, 0);
  EXPECT_FALSE(DisparityRefiner(flat, flat).refine({40, 20, 7.0, 0, 0}));
  const DisparityRefiner refiner(left, right);
  EXPECT_FALSE(refiner.refine({1, 20, 7.0, 0, 0}));   // the patch leaves the left picture
  EXPECT_FALSE(refiner.refine({8, 20, 7.0, 0, 0}));   // the right one
  EXPECT_FALSE(refiner.refine({40, 20, 5.0, 0, 0}));  // too far from the truth
  EXPECT_FALSE(refiner.refine({40, 39, 7.0, 0, 0}));
}

TEST(DisparityRefiner, ABrighterRightEyeDoesNotMatter) {
  const cv::Mat left = pattern(0, 0, 0);
  cv::Mat right = pattern(7.3, 0, 0);
  right += 20;
  const auto found = DisparityRefiner(left, right).refine({40, 20, 7.0, 0, 0});
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 7.3, 0.04);
}

}  // namespace
}  // namespace cairn::stereo
