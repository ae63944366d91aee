// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/corner_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace cairn::visual_odometry {
namespace {

/// Blurred noise.
cv::Mat texture(std::uint64_t seed, const cv::Size& size = {320, 200}) {
  cv::Mat picture(size, CV_8UC1);
  cv::RNG random(seed);
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(picture, picture, {7, 7}, 2);
  cv::normalize(picture, picture, 0, 255, cv::NORM_MINMAX);
  return picture;
}

/// All but a border.
cv::Mat inner(const cv::Mat& picture) {
  cv::Mat mask(picture.size(), CV_8UC1, cv::Scalar(0));
  mask({6, 6, picture.cols - 12, picture.rows - 12}).setTo(255);
  return mask;
}

/// OpenCV computes in rounded numbers: the order of corners that are nearly as strong may differ.
TEST(CornerDetector, FindsWhatOpenCvFinds) {
  CornerDetector detector;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const cv::Mat picture = texture(seed);
    cv::Mat allowed = inner(picture);
    cv::circle(allowed, {100, 80}, 30, cv::Scalar(0), cv::FILLED);
    const CornerConfig config{.most = 150, .spacing_px = 12, .quality = 0.01};
    std::vector<cv::Point2f> expected;
    cv::goodFeaturesToTrack(picture, expected, config.most, config.quality, config.spacing_px, allowed, 3);
    const auto corners = detector.find(picture, allowed, config);
    ASSERT_EQ(corners.size(), expected.size());
    std::size_t same = 0;
    for (const cv::Point& c : corners) same += static_cast<std::size_t>(std::ranges::count(expected, cv::Point2f(c)));
    EXPECT_GE(same + 3, corners.size());
  }
}

TEST(CornerDetector, KeepsSpacingNumberAndForbiddenPlaces) {
  CornerDetector detector;
  const cv::Mat picture = texture(5);
  cv::Mat allowed = inner(picture);
  allowed({0, 0, 160, 200}).setTo(0);
  const auto all = detector.find(picture, allowed, {.most = 1000, .spacing_px = 15, .quality = 0.001});
  ASSERT_GT(all.size(), 30U);
  for (const cv::Point& a : all) {
    EXPECT_NE(allowed.at<unsigned char>(a), 0) << a;
    for (const cv::Point& b : all) {
      EXPECT_TRUE(a == b || (a - b).ddot(a - b) >= 15 * 15) << a << b;
    }
  }
  const auto some = detector.find(picture, allowed, {.most = 10, .spacing_px = 15, .quality = 0.001});
  ASSERT_EQ(some.size(), 10U);
  EXPECT_TRUE(std::ranges::equal(some, std::span(all).first(10))) << "the strongest ones";
}

TEST(CornerDetector, ACornerIsThereAndAnEdgeIsNone) {
  CornerDetector detector;
  cv::Mat picture(60, 80, CV_8UC1, cv::Scalar(40));
  picture({30, 25, 50, 35}).setTo(200);
  const auto corners = detector.find(picture, inner(picture), {.most = 10, .spacing_px = 5, .quality = 0.3});
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_LE(std::abs(corners[0].x - 30), 1);
  EXPECT_LE(std::abs(corners[0].y - 25), 1);
}

TEST(CornerDetector, APlainPictureHasNone) {
  CornerDetector detector;
  const cv::Mat plain(50, 60, CV_8UC1, cv::Scalar(128));
  EXPECT_TRUE(detector.find(plain, inner(plain), {}).empty());
  const cv::Mat picture = texture(6);
  EXPECT_TRUE(detector.find(picture, cv::Mat(picture.size(), CV_8UC1, cv::Scalar(0)), {}).empty());
}

/// The tracker's pictures are parts of larger ones.
TEST(CornerDetector, WhatLiesBesideAPictureDoesNotMatter) {
  CornerDetector detector;
  const cv::Mat large = texture(7);
  const cv::Mat part = large({40, 30, 200, 120}), alone = part.clone();
  const CornerConfig config{.most = 100, .spacing_px = 10, .quality = 0.01};
  EXPECT_EQ(detector.find(part, inner(part), config), detector.find(alone, inner(alone), config));
}

}  // namespace
}  // namespace cairn::visual_odometry
