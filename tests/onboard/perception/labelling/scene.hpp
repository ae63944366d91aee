// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "hal/labels.hpp"
#include "onboard/perception/labelling/point_labeller.hpp"

// A world that can be computed by hand: a car's side 6 m ahead, a building's wall 12 m ahead, and the road.
namespace cairn::labelling::test {

using Eigen::Vector3d;

inline const std::uint8_t kRoad = *find_class("road"), kBuilding = *find_class("building"), kCar = *find_class("car");

/// What a ray meets first.
struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint8_t class_id = kSkyClass;
};

inline Hit look(const Vector3d& eye, const Vector3d& direction) {
  Hit hit;
  const auto meet = [&](double t, std::uint8_t class_id, auto&& inside) {
    if (t > 1e-6 && t < hit.distance && inside(Vector3d(eye + t * direction))) hit = {t, class_id};
  };
  meet((12 - eye.x()) / direction.x(), kBuilding, [](const Vector3d& p) { return p.z() > 0 && p.z() < 5; });
  meet((6 - eye.x()) / direction.x(), kCar,
       [](const Vector3d& p) { return p.z() > 0 && p.z() < 1.8 && std::abs(p.y()) < 1.5; });
  meet(-eye.z() / direction.z(), kRoad, [](const Vector3d& p) { return p.x() < 12; });
  return hit;
}

/// A sweep of a LiDAR at the height of 1.5 m, whose base is at `T_odom_base`: as the scan of a robot that stands.
inline PlacedScan scan_from(const SE3& T_odom_base, double step_rad = 0.004, double ring_step = 0.01) {
  PlacedScan scan;
  scan.T_odom_base = T_odom_base;
  const Vector3d lidar(0, 0, 1.5);
  for (double elevation = -0.3; elevation < 0.25; elevation += ring_step)
    for (double azimuth = -0.8; azimuth < 0.8; azimuth += step_rad) {
      const Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                         std::sin(elevation));
      const Hit hit = look(T_odom_base * lidar, T_odom_base.quaternion() * ray);
      if (hit.distance < 50) scan.points_base.push_back((lidar + hit.distance * ray).cast<float>());
    }
  return scan;
}

inline cameras::CameraModel small_camera() {
  cameras::CameraParameters p{
      .width = 320, .height = 240, .fx = 200, .fy = 200, .cx = 159.5, .cy = 119.5, .distortion = {}};
  p.distortion.k = {-0.1, 0.01};
  return *cameras::CameraModel::create(p);
}

/// 0.3 m to the left of the LiDAR, and lower.
inline SE3 mount() { return SE3::from_xyz_rpy((Vector6() << 0.2, 0.3, 1.2, 0.01, 0.02, -0.03).finished()); }

/// Where each pixel of small_camera() looks, row by row; computed once, because it takes long.
inline const std::vector<Vector3d>& rays() {
  static const std::vector<Vector3d> all = [] {
    const auto camera = small_camera();
    std::vector<Vector3d> directions;
    for (int v = 0; v < camera.height(); ++v)
      for (int u = 0; u < camera.width(); ++u) directions.push_back(camera.unproject({u, v}).value());
    return directions;
  }();
  return all;
}

/// What small_camera() sees from there; probability 255.
inline LabelImage picture_from(const SE3& T_odom_base) {
  LabelImage labels;
  labels.resize(small_camera().width(), small_camera().height());
  const SE3 T_odom_optical = T_odom_base * mount() * cameras::T_camera_optical();
  const Eigen::Matrix3d R = T_odom_optical.rotation();
  for (std::size_t i = 0; i < labels.classes.size(); ++i) {
    labels.classes[i] = look(T_odom_optical.translation(), R * rays()[i]).class_id;
    labels.probabilities[i] = 255;
  }
  return labels;
}

/// The class of a point of the world, from where it lies.
inline std::uint8_t true_class(const Vector3d& p) {
  if (std::abs(p.x() - 12) < 1e-3) return kBuilding;
  return std::abs(p.x() - 6) < 1e-3 && p.z() > 1e-3 ? kCar : kRoad;
}

inline std::size_t wrong_labels(const std::vector<LabelledPoint>& points) {
  std::size_t wrong = 0;
  for (const LabelledPoint& p : points) wrong += p.class_id != true_class(p.point_odom.cast<double>()) ? 1 : 0;
  return wrong;
}

}  // namespace cairn::labelling::test
