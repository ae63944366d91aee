// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/dense_stereo.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/stereo_view.hpp"

namespace cairn::stereo {
namespace {

const SE3 T_body_optical = cameras::T_camera_optical();

/// The points of the furnished room from its middle, looking along x, in the world.
std::vector<Eigen::Vector3f> room_points(double max_range_m) {
  const support::World world = support::furnished_room();
  support::StereoView view(world, support::small_eyes(), 1);
  const SE3 T_world_eye = SE3(Eigen::Quaterniond::Identity(), {-2, 0, 1.4}) * T_body_optical;
  StereoPair pair;
  view.shoot(T_world_eye, Time{}, pair);
  DenseStereo dense({.disparities = 64}, support::small_eyes());
  std::vector<Eigen::Vector3f> points;
  dense.measure(pair, max_range_m, points);
  for (Eigen::Vector3f& p : points) p = (T_world_eye * p.cast<double>()).cast<float>();
  return points;
}

/// Distance to the nearest surface of the room.
double off(const Eigen::Vector3f& p) {
  const double x = p.x(), y = p.y(), z = p.z();
  double nearest = std::min({std::abs(5 - x), std::abs(4 - std::abs(y)), std::abs(z), std::abs(3 - z)});
  const auto box = [&](double x0, double x1, double y0, double y1, double z1) {
    const double dx = std::max({x0 - x, x - x1, 0.0}), dy = std::max({y0 - y, y - y1, 0.0});
    const double dz = std::max(z - z1, 0.0);
    nearest = std::min(nearest, std::hypot(dx, dy, dz));
  };
  box(2, 3, -3, -2, 1.2);
  box(2.5, 3.5, 1, 2.5, 0.8);
  return std::abs(nearest);
}

TEST(DenseStereo, PointsLieOnTheSurfacesThatBothEyesSee) {
  const auto points = room_points(8);
  ASSERT_GT(points.size(), 800U);
  std::vector<double> errors;
  for (const Eigen::Vector3f& p : points) errors.push_back(off(p));
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.05);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.25);
}

TEST(DenseStereo, NoPointIsFartherThanAsked) {
  const auto points = room_points(4);
  ASSERT_FALSE(points.empty());
  for (const Eigen::Vector3f& p : points) EXPECT_LE(p.x(), 2.01F);
}

TEST(DenseStereo, APictureOfNothingHasNoPoints) {
  StereoPair pair;
  for (Image* eye : {&pair.left, &pair.right}) {
    eye->resize(PixelFormat::kMono8, support::small_eyes().width, support::small_eyes().height);
    std::ranges::fill(eye->bytes, std::byte{90});
  }
  DenseStereo dense({.disparities = 64}, support::small_eyes());
  std::vector<Eigen::Vector3f> points{{1, 2, 3}};
  dense.measure(pair, 8, points);
  EXPECT_TRUE(points.empty());
}

}  // namespace
}  // namespace cairn::stereo
