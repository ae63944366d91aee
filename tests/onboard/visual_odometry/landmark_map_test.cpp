// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/landmark_map.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

const stereo::StereoGeometry kLandmarkEyes = support::small_eyes();
constexpr PixelNoise kNoise{0.3, 0.3};

Feature seen(std::uint32_t id, const Eigen::Vector3d& p_eye) {
  const Eigen::Vector3d z = kLandmarkEyes.project(p_eye);
  return {id, {static_cast<float>(z.x()), static_cast<float>(z.y())}, static_cast<float>(z.z()), nullptr};
}

TEST(LandmarkMap, ALandmarkIsWhereBothEyesSeeItAndItsDepthIsLeastCertain) {
  LandmarkMap map(kLandmarkEyes, kNoise, 40);
  const Eigen::Vector3d p(0.5, -0.2, 4);
  map.add(seen(7, p), {}, 3);
  const Landmark* landmark = map.find(7);
  ASSERT_NE(landmark, nullptr);
  EXPECT_LT((landmark->p_odom - p).norm(), 1e-3);
  EXPECT_EQ(landmark->epoch, 3);
  const double depth = std::sqrt(landmark->covariance(2, 2)), side = std::sqrt(landmark->covariance(1, 1));
  EXPECT_NEAR(depth, 16 * 0.3 / (136 * 0.12), 0.02);  // z² σ / (f b)
  EXPECT_LT(side, depth / 5);
}

TEST(LandmarkMap, WithoutADisparityOrTooFarAwayThereIsNone) {
  LandmarkMap map(kLandmarkEyes, kNoise, 10);
  Feature flat = seen(1, {0, 0, 4});
  flat.disparity.reset();
  map.add(flat, {}, 0);
  map.add(seen(2, {0, 0, 11}), {}, 0);
  EXPECT_EQ(map.size(), 0U);
}

TEST(LandmarkMap, ALandmarkIsMovedToWhereItIsKnownToBe) {
  LandmarkMap map(kLandmarkEyes, kNoise, 40);
  map.add(seen(1, {0, 0, 4}), {}, 2);
  const Eigen::Vector3d there(0.1, 0, 4.1);
  map.move(1, there, 0.01 * Eigen::Matrix3d::Identity());
  map.move(5, there, Eigen::Matrix3d::Identity());
  EXPECT_EQ(map.find(1)->p_odom, there);
  EXPECT_EQ(map.find(1)->covariance(0, 0), 0.01);
  EXPECT_EQ(map.find(1)->epoch, 2);
  EXPECT_EQ(map.size(), 1U);
}

TEST(LandmarkMap, KeepsWhatFeaturesShow) {
  LandmarkMap map(kLandmarkEyes, kNoise, 40);
  for (std::uint32_t id = 1; id <= 4; ++id) map.add(seen(id, {0.1 * id, 0, 4}), {}, 0);
  const std::array<Feature, 2> left{seen(2, {0, 0, 4}), seen(9, {0, 0, 4})};
  map.keep(left);
  EXPECT_EQ(map.size(), 1U);
  EXPECT_NE(map.find(2), nullptr);
}

}  // namespace
}  // namespace cairn::visual_odometry
