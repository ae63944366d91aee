// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/alignment/alignment_score.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/onboard/perception/alignment/sweep.hpp"

namespace cairn::alignment {
namespace {

namespace scene = labelling::test;

/// A camera with enough pixels to tell half a degree.
cameras::CameraModel sharp_camera() {
  return *cameras::CameraModel::create(
      {.width = 1280, .height = 960, .fx = 800, .fy = 800, .cx = 639.5, .cy = 479.5, .distortion = {}});
}

/// What it sees, each class in a grey of its own.
Image grey_picture(const cameras::CameraModel& camera, const SE3& T_odom_base) {
  Image image;
  image.resize(PixelFormat::kMono8, camera.width(), camera.height());
  const SE3 T_odom_optical = T_odom_base * scene::mount() * cameras::T_camera_optical();
  const auto& p = camera.parameters();
  for (int v = 0; v < p.height; ++v)
    for (int u = 0; u < p.width; ++u) {
      const Eigen::Vector3d ray((u - p.cx) / p.fx, (v - p.cy) / p.fy, 1);
      const auto hit = scene::look(T_odom_optical.translation(), T_odom_optical.quaternion() * ray);
      image.bytes[static_cast<std::size_t>(v * p.width + u)] =
          std::byte{static_cast<unsigned char>(10 + 17 * hit.class_id)};
    }
  return image;
}

/// What the camera sees from a pose, and where its edges are. Made once for all mounts.
PictureEdges picture_from(const SE3& T_odom_base) {
  PictureEdges picture;
  const Image image = grey_picture(sharp_camera(), T_odom_base);
  picture.compute(image.view());
  return picture;
}

AlignmentScore score_of(const PictureEdges& picture, const SE3& T_base_camera, const SE3& T_scan_exposure = SE3()) {
  static const test::Sweep s = test::sweep(true, 0.004, 0.002);
  static DepthEdgeFinder finder;
  static const auto edges = finder.find(s.cloud, s.points_base, Eigen::Matrix3d::Identity());
  AlignmentScore score(sharp_camera(), T_base_camera);
  score.add(picture, edges, T_scan_exposure);
  return score;
}

TEST(AlignmentScore, TheTrueMountIsTheBest) {
  const AlignmentScore score = score_of(picture_from(SE3()), scene::mount());
  EXPECT_GT(score.edges(), AlignmentScore::kLeastEdges);
  const auto distances = score.distances();
  EXPECT_LT(distances[0].median_px, 1.5);
  EXPECT_GT(distances[0].within_2px, 0.9);
  EXPECT_TRUE(score.given_mount_is_best());
}

TEST(AlignmentScore, AMountThatWasKnockedIsNot) {
  const PictureEdges picture = picture_from(SE3());
  for (int axis = 3; axis < 6; ++axis)
    for (const double degrees : {-1.0, 1.0}) {
      Vector6 xi = Vector6::Zero();
      xi[axis] = degrees * std::numbers::pi / 180;
      EXPECT_FALSE(score_of(picture, scene::mount() * SE3::exp(xi)).given_mount_is_best()) << axis << " " << degrees;
    }
}

TEST(AlignmentScore, TheCameraMovedBetweenScanAndExposure) {
  const SE3 moved = SE3::from_xyz_rpy((Vector6() << 0.3, 0.05, 0, 0, 0, 0.06).finished());
  EXPECT_TRUE(score_of(picture_from(moved), scene::mount(), moved).given_mount_is_best());
}

TEST(AlignmentScore, WithoutEdgesNothingIsBest) {
  const AlignmentScore score(sharp_camera(), scene::mount());
  EXPECT_FALSE(score.given_mount_is_best());
  EXPECT_EQ(score.distances()[0].within_2px, 0);
}

}  // namespace
}  // namespace cairn::alignment
