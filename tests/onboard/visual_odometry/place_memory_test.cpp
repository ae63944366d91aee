// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/place_memory.hpp"

#include <gtest/gtest.h>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

const stereo::StereoGeometry kPlaceEyes = support::small_eyes();

/// A view of the furnished room, with corners on a grid whose landmarks are known.
struct View {
  stereo::StereoPair pair;
  FeatureTracker tracker{{.features = 120, .spacing_px = 12}, kPlaceEyes};
  SE3 T_world_eye;

  View(const Eigen::Vector3d& position, double yaw, unsigned seed) {
    const support::World world = support::furnished_room();
    support::StereoView view(world, kPlaceEyes, seed);
    const Vector6 pose = (Vector6() << position, 0, 0, yaw).finished();
    T_world_eye = SE3::from_xyz_rpy(pose) * cameras::T_camera_optical();
    view.shoot(T_world_eye, Time{}, pair);
    tracker.follow(pair, [](const Feature&) { return std::nullopt; });
    tracker.add_corners();
  }
};

TEST(PlaceMemory, RecallsAPlaceFromNearBy) {
  View before({-2, 0, 1.4}, 0, 1), now({-1.8, 0.1, 1.4}, 0.05, 2), elsewhere({2, 0, 1.4}, 3, 3);
  LandmarkMap landmarks(kPlaceEyes, {0.35, 0.35}, 40);
  for (const Feature& f : before.tracker.features()) landmarks.add(f, before.T_world_eye, 0);
  PlaceMemory memory(kPlaceEyes.baseline_m);
  memory.remember(Time{}, before.pair.left, before.tracker.features(), landmarks, before.T_world_eye);
  const auto place = memory.recall(now.pair.left, now.tracker.features());
  ASSERT_GE(place.matches.size(), 15U);
  int right = 0;
  for (const Match& m : place.matches) {
    const Eigen::Vector3d expected = kPlaceEyes.project(now.T_world_eye.inverse() * m.landmark.p_odom);
    right += (expected - m.seen).head<2>().norm() < 3 ? 1 : 0;
  }
  EXPECT_GT(2 * right, static_cast<int>(place.matches.size()));
  const auto other = memory.recall(elsewhere.pair.left, elsewhere.tracker.features());
  EXPECT_LT(2 * other.matches.size(), place.matches.size());
  memory.clear();
  EXPECT_TRUE(memory.recall(now.pair.left, now.tracker.features()).matches.empty());
}

TEST(PlaceMemory, DescriptorsDoNotLookOutsideOfThePicture) {
  Image picture;
  picture.resize(PixelFormat::kMono8, 40, 30);
  std::ranges::fill(picture.bytes, std::byte{7});
  const std::vector<Spot> corners{{{0, 0}, 1}, {{39, 29}, 2.5F}, {{0, 29}, 0.4F}, {{39, 0}, 10}};
  EXPECT_EQ(describe(picture, corners).size(), 4U);
}

}  // namespace
}  // namespace cairn::visual_odometry
