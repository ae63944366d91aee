// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/rectifier.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::stereo {
namespace {

cameras::CameraModel bent_eye(double k1) {
  cameras::CameraParameters p{.width = 80, .height = 60, .fx = 60, .fy = 60, .cx = 39.5, .cy = 29.5, .distortion = {}};
  p.distortion.k[0] = k1;
  return cameras::CameraModel::create(p).value();
}

/// Each eye sees a bright dot where the lens puts the ray (x, y, 1).
Image dots(const cameras::CameraModel& eye, double x, double y) {
  Image both;
  both.resize(PixelFormat::kMono8, 160, 60);
  std::ranges::fill(both.bytes, std::byte{0});
  const Eigen::Vector2d seen = eye.project({x, y, 1}).value();
  for (const int left : {0, 80})
    for (int v = 0; v < 60; ++v)
      for (int u = 0; u < 80; ++u) {
        const double d2 = (Eigen::Vector2d(u, v) - seen).squaredNorm();
        both.bytes[static_cast<std::size_t>(v * 160 + left + u)] =
            static_cast<std::byte>(std::lround(250 * std::exp(-d2 / 4)));
      }
  return both;
}

Eigen::Vector2d centre(const Image& image) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const double w = image.view().at<std::uint8_t>(u, v);
      sum += w * Eigen::Vector2d(u, v);
      weight += w;
    }
  return sum / weight;
}

TEST(Rectifier, TakesTheDistortionOutOfBothEyes) {
  const cameras::CameraModel eye = bent_eye(-0.25);
  const Rectifier rectifier = Rectifier::create(eye, 0.1).value();
  StereoPair pair;
  ASSERT_TRUE(rectifier.rectify(dots(eye, 0.4, -0.3), pair));
  const Eigen::Vector2d ideal(60 * 0.4 + 39.5, 60 * -0.3 + 29.5);
  EXPECT_LT((centre(pair.left) - ideal).norm(), 0.15);
  EXPECT_LT((centre(pair.right) - ideal).norm(), 0.15);
  EXPECT_GT((eye.project({0.4, -0.3, 1}).value() - ideal).norm(), 1);  // the lens had moved it
}

TEST(Rectifier, WithoutDistortionEachEyeIsCopied) {
  const cameras::CameraModel eye = bent_eye(0);
  const Rectifier rectifier = Rectifier::create(eye, 0.1).value();
  const Image both = dots(eye, 0.1, 0.1);
  StereoPair pair;
  ASSERT_TRUE(rectifier.rectify(both, pair));
  for (int v = 0; v < 60; ++v)
    for (int u = 0; u < 80; ++u) {
      ASSERT_EQ(pair.left.view().at<std::uint8_t>(u, v), both.view().at<std::uint8_t>(u, v));
      ASSERT_EQ(pair.right.view().at<std::uint8_t>(u, v), both.view().at<std::uint8_t>(80 + u, v));
    }
  EXPECT_EQ(pair.left.format, PixelFormat::kMono8);
}

TEST(Rectifier, RefusesWhatIsNoPictureOfItsCamera) {
  const Rectifier rectifier = Rectifier::create(bent_eye(0), 0.1).value();
  StereoPair pair;
  Image other;
  other.resize(PixelFormat::kMono8, 80, 60);
  EXPECT_EQ(rectifier.rectify(other, pair).error().code, Errc::kMalformed);
  other.resize(PixelFormat::kDepth16, 160, 60);
  EXPECT_EQ(rectifier.rectify(other, pair).error().code, Errc::kMalformed);
  EXPECT_EQ(Rectifier::create(bent_eye(0), 0).error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::stereo
