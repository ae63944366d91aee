// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/patch.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

constexpr int kSize = 80;
const Eigen::Vector2f kMiddle(40.3F, 38.8F);

struct Look {
  PatchPose pose{.middle = kMiddle, .warp = Eigen::Matrix2f::Identity()};  // of what kMiddle shows unwarped
  double gain = 1, offset = 0;
  double plane = 0;  // of the texture: another one shows something else
};

/// A painted plane, warped, with noise.
cv::Mat picture_of(const Look& look, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1.0);
  cv::Mat picture(kSize, kSize, CV_8UC1);
  const Eigen::Matrix2f back = look.pose.warp.inverse();
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Eigen::Vector2f at =
          kMiddle + back * (Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - look.pose.middle);
      const double grey = 150 * support::texture({at.x(), at.y(), look.plane}, 6) + 30;
      picture.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(look.gain * grey + look.offset + noise(random));
    }
  return picture;
}

TEST(Patch, IsFoundWhereItWasWarpedMovedAndLitDifferently) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto patch = Patch::cut(picture_of({}, 1), kMiddle);
  ASSERT_TRUE(patch);
  int found = 0;
  for (unsigned i = 0; i < 60; ++i) {
    const float turn = 0.2F * unit(random), scale = 1 + 0.15F * unit(random);
    Look look{.gain = 1 + 0.3 * unit(random), .offset = 10.0 * unit(random)};
    look.pose.middle += Eigen::Vector2f(unit(random), unit(random));
    look.pose.warp << scale * std::cos(turn), -std::sin(turn) + 0.1F * unit(random), std::sin(turn), scale;
    const auto pose = patch->find(picture_of(look, 10 + i), {.middle = kMiddle, .warp = Eigen::Matrix2f::Identity()});
    if (!pose) continue;
    ++found;
    EXPECT_LT((pose->middle - look.pose.middle).norm(), 0.12F) << i;
    EXPECT_LT((pose->warp - look.pose.warp).norm(), 0.08F) << i;
  }
  EXPECT_GE(found, 55);
}

TEST(Patch, IsNotFoundInWhatLooksDifferent) {
  const auto patch = Patch::cut(picture_of({}, 1), kMiddle);
  ASSERT_TRUE(patch);
  int found = 0;
  for (unsigned i = 0; i < 40; ++i)
    found += patch->find(picture_of({.plane = 20.0 + i}, i), {.middle = kMiddle, .warp = Eigen::Matrix2f::Identity()})
                 ? 1
                 : 0;
  EXPECT_LE(found, 2);
}

TEST(Patch, NeedsStructureAndRoom) {
  EXPECT_FALSE(Patch::cut(cv::Mat(kSize, kSize, CV_8UC1, cv::Scalar(90)), kMiddle));
  const cv::Mat picture = picture_of({}, 1);
  for (const Eigen::Vector2f& edge : {Eigen::Vector2f(3, 40), {40, 3}, {kSize - 4, 40}, {40, kSize - 4}, {-5, 200}})
    EXPECT_FALSE(Patch::cut(picture, edge)) << edge.transpose();
}

TEST(Patch, AnEdgeAloneDoesNotTellHowItLies) {
  cv::Mat edge(kSize, kSize, CV_8UC1, cv::Scalar(40));
  edge.colRange(40, kSize).setTo(200);
  EXPECT_FALSE(Patch::cut(edge, {40, 40}));
}

TEST(Patch, ASearchFromOutsideThePictureEnds) {
  const cv::Mat picture = picture_of({}, 1);
  const auto patch = Patch::cut(picture, kMiddle);
  ASSERT_TRUE(patch);
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (const Eigen::Vector2f& start : {Eigen::Vector2f(-20, 40), {40, 1e9F}, {none, 40}})
    EXPECT_FALSE(patch->find(picture, {.middle = start, .warp = Eigen::Matrix2f::Identity()}));
  EXPECT_FALSE(patch->find(picture, {.middle = kMiddle, .warp = Eigen::Matrix2f::Constant(none)}));
}

}  // namespace
}  // namespace cairn::visual_odometry
