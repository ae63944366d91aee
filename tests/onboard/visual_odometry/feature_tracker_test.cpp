// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/feature_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

const stereo::StereoGeometry kTrackerEyes = support::small_eyes();

/// Flies forward, so that all patches grow.
SE3 forward(int i) {
  return SE3::from_xyz_rpy((Vector6() << -3 + 0.05 * i, 0.01 * i, 1.5, 0.004 * i, 0.1, 0.005 * i).finished()) *
         cameras::T_camera_optical();
}

double middle_of(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

TEST(FeatureTracker, ACornerStaysOnItsPoint) {
  const support::World world = support::furnished_room();
  support::StereoView view(world, kTrackerEyes, 4);
  FeatureTracker tracker({.features = 120, .spacing_px = 12}, kTrackerEyes);
  stereo::StereoPair pair;
  std::map<std::uint32_t, Eigen::Vector3d> points;
  constexpr int kPictures = 20;
  for (int i = 0; i < kPictures; ++i) {
    view.shoot(forward(i), Time{from_seconds(1 + 0.05 * i)}, pair);
    tracker.follow(pair, [](const Feature&) { return std::nullopt; });
    if (i > 0) continue;
    tracker.add_corners();
    for (const Feature& f : tracker.features()) {
      const Eigen::Vector3d ray = kTrackerEyes.point(f.left.x(), f.left.y(), 1).normalized();
      const Eigen::Vector3d direction = forward(0).rotation() * ray;
      points[f.id] = forward(0).translation() + world.cast(forward(0).translation(), direction) * direction;
    }
  }
  std::vector<double> off_px, off_disparity;
  for (const Feature& f : tracker.features()) {
    const Eigen::Vector3d expected = kTrackerEyes.project(forward(kPictures - 1).inverse() * points.at(f.id));
    off_px.push_back((expected.head<2>() - f.left.cast<double>()).norm());
    if (f.disparity) off_disparity.push_back(std::abs(expected.z() - *f.disparity));
  }
  ASSERT_GT(off_px.size(), 40U);
  ASSERT_GT(off_disparity.size(), 40U);
  EXPECT_LT(middle_of(off_px), 0.15);
  EXPECT_LT(middle_of(off_disparity), 0.15);
}

}  // namespace
}  // namespace cairn::visual_odometry
