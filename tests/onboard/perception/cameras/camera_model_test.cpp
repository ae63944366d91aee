// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/cameras/camera_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace cairn::cameras {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

CameraParameters plain() {
  return {.width = 640, .height = 480, .fx = 400, .fy = 410, .cx = 320.5, .cy = 239.25, .distortion = {}};
}

CameraParameters with(DistortionModel model, std::array<double, 8> k) {
  CameraParameters p = plain();
  p.distortion = {model, k};
  return p;
}

/// Lenses as calibrations give them: EuRoC's cam0, a rational one of a wide camera, and a fisheye (TUM-VI).
std::vector<CameraParameters> lenses() {
  return {plain(), with(DistortionModel::kRadTan, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}),
          with(DistortionModel::kRadTan, {-0.32, 0.12, 1e-3, -5e-4, -0.02}),
          with(DistortionModel::kRadTan, {8.1, 4.2, 1e-4, -2e-4, 0.2, 8.4, 7.0, 1.1}),
          with(DistortionModel::kEquidistant, {0.0034823894, 0.0007150348, -0.0020532361, 0.00020293673})};
}

CameraModel made(const CameraParameters& p) {
  auto model = CameraModel::create(p);
  EXPECT_TRUE(model) << to_string(model.error());
  return *model;
}

TEST(CameraModel, APlainPinholeIsTheEquation) {
  const CameraModel camera = made(plain());
  EXPECT_EQ(*camera.project({0, 0, 7}), Vector2d(320.5, 239.25));
  const Vector2d pixel = *camera.project({0.3, -0.2, 2});
  EXPECT_NEAR(pixel.x(), 400 * 0.15 + 320.5, 1e-12);
  EXPECT_NEAR(pixel.y(), 410 * -0.1 + 239.25, 1e-12);
}

/// The equations of OpenCV's documentation (calib3d, and its fisheye), written out for one point.
TEST(CameraModel, DistortionIsOpenCvs) {
  const double x = 0.4, y = -0.3, s = 0.25;
  const CameraModel radtan = made(lenses()[2]);
  const double f = 1 - 0.32 * s + 0.12 * s * s - 0.02 * s * s * s;
  const double xd = x * f + 2 * 1e-3 * x * y - 5e-4 * (s + 2 * x * x);
  const double yd = y * f + 1e-3 * (s + 2 * y * y) + 2 * -5e-4 * x * y;
  EXPECT_NEAR((*radtan.project({x, y, 1}) - Vector2d(400 * xd + 320.5, 410 * yd + 239.25)).norm(), 0, 1e-9);

  const CameraModel fisheye = made(lenses()[4]);
  const double a = std::atan(0.5), a2 = a * a;
  const double d = a * (1 + a2 * (0.0034823894 + a2 * (0.0007150348 + a2 * (-0.0020532361 + a2 * 0.00020293673))));
  const Vector2d bent = Vector2d(x, y) * d / 0.5;
  EXPECT_NEAR((*fisheye.project({x, y, 1}) - Vector2d(400 * bent.x() + 320.5, 410 * bent.y() + 239.25)).norm(), 0,
              1e-9);
}

TEST(CameraModel, UnprojectIsTheInverseOfProject) {
  for (const CameraParameters& p : lenses()) {
    const CameraModel camera = made(p);
    for (int v = 0; v < p.height; v += 31)
      for (int u = 0; u < p.width; u += 37) {
        const auto ray = camera.unproject(Vector2d(u, v));
        ASSERT_TRUE(ray) << u << " " << v;
        EXPECT_NEAR(ray->norm(), 1, 1e-12);
        const auto pixel = camera.project(3.7 * *ray);
        ASSERT_TRUE(pixel) << u << " " << v;
        EXPECT_LT((*pixel - Vector2d(u, v)).norm(), 1e-6);
      }
  }
}

TEST(CameraModel, WhatLiesBehindOrBesideIsNotSeen) {
  const CameraModel camera = made(plain());
  EXPECT_FALSE(camera.project({0, 0, -1}));
  EXPECT_FALSE(camera.project({0, 0, 0}));
  EXPECT_FALSE(camera.project({1, 0, 1}));
  EXPECT_FALSE(camera.project({0, -1, 1}));
  EXPECT_FALSE(camera.project({std::nan(""), 0, 1}));
  EXPECT_FALSE(camera.project({0, 0, std::nan("")}));
  EXPECT_FALSE(camera.project({0, 0, INFINITY}));
}

TEST(CameraModel, ThePictureReachesHalfAPixelBeyondTheCentresAtItsRim) {
  const CameraModel camera = made(plain());
  EXPECT_TRUE(camera.in_picture({-0.5, -0.5}));
  EXPECT_TRUE(camera.in_picture({639.49, 479.49}));
  EXPECT_FALSE(camera.in_picture({-0.51, 0}));
  EXPECT_FALSE(camera.in_picture({639.5, 0}));
  EXPECT_FALSE(camera.in_picture({0, 479.5}));
}

/// The true picture: a ray farther out lands farther out, in every direction, and never comes back.
TEST(CameraModel, RaysFromBesideTheViewDoNotFoldIntoThePicture) {
  auto cameras = lenses();
  cameras.push_back(with(DistortionModel::kRadTan, {-0.4, 0.1}));
  cameras.push_back(with(DistortionModel::kRadTan, {0, 0, 0.01, -0.01}));
  cameras.push_back(with(DistortionModel::kRadTan, {0, 0, 0, 0, 0, -0.5}));
  cameras.push_back(with(DistortionModel::kEquidistant, {-0.3, 0.02}));
  for (const CameraParameters& p : cameras) {
    const CameraModel camera = made(p);
    for (int degrees = 0; degrees < 360; degrees += 15) {
      const double direction = degrees * std::numbers::pi / 180;
      double last = 0;
      bool left = false;
      for (int i = 1; i < 900; ++i) {
        const double r = std::tan(i * 0.1 * std::numbers::pi / 180);
        const auto pixel = camera.project({r * std::cos(direction), r * std::sin(direction), 1});
        left = left || !pixel;
        ASSERT_FALSE(left && pixel) << p.distortion.k[0] << ": at " << degrees << " comes back at " << 0.1 * i;
        if (!pixel) continue;
        const double out = Vector2d((pixel->x() - p.cx) / p.fx, (pixel->y() - p.cy) / p.fy).norm();
        ASSERT_GT(out, last);
        last = out;
      }
    }
  }
}

TEST(CameraModel, AScaledPictureShowsTheSameShares) {
  for (const CameraParameters& p : lenses()) {
    const CameraModel camera = made(p), half = camera.scaled(320, 120);
    for (const Vector3d& point : {Vector3d(0, 0, 1), Vector3d(0.3, -0.2, 1), Vector3d(-0.5, 0.4, 1.1)}) {
      const Vector2d a = *camera.project(point), b = *half.project(point);
      EXPECT_NEAR((a.x() + 0.5) / 640, (b.x() + 0.5) / 320, 1e-12);
      EXPECT_NEAR((a.y() + 0.5) / 480, (b.y() + 0.5) / 120, 1e-12);
    }
  }
}

TEST(CameraModel, AllFaultsAreReportedAtOnce) {
  CameraParameters p = plain();
  p.width = 0;
  p.fx = -1;
  p.cy = std::nan("");
  p.distortion.k[1] = INFINITY;
  const auto model = CameraModel::create(p);
  ASSERT_FALSE(model);
  for (const char* key : {"width", "fx", "cy", "distortion"})
    EXPECT_NE(model.error().detail.find(key), std::string::npos) << model.error().detail;
  EXPECT_EQ(model.error().detail.find("height"), std::string::npos);
}

TEST(CameraModel, ADistortionThatTurnsBackAtOnceIsRefused) {
  EXPECT_FALSE(CameraModel::create(with(DistortionModel::kRadTan, {-1e6})));
  EXPECT_FALSE(CameraModel::create(with(DistortionModel::kEquidistant, {-1e6})));
}

TEST(CameraModel, TheOpticalFrameLooksAlongXOfTheBody) {
  const SE3 T = T_camera_optical();
  EXPECT_LT((T * Vector3d(0, 0, 1) - Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((T * Vector3d(1, 0, 0) - Vector3d(0, -1, 0)).norm(), 1e-15);
  EXPECT_LT((T * Vector3d(0, 1, 0) - Vector3d(0, 0, -1)).norm(), 1e-15);
}

}  // namespace
}  // namespace cairn::cameras
