// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "hal/image.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::mount::test {

inline constexpr double kDegree = std::numbers::pi / 180;

inline cameras::CameraModel small_camera() {
  return *cameras::CameraModel::create(
      {.width = 160, .height = 120, .fx = 110, .fy = 110, .cx = 79.5, .cy = 59.5, .distortion = {}});
}

/// T_base_camera of the test's robot, body axes.
inline SE3 true_mount() { return SE3::from_xyz_rpy((Vector6() << 0.3, 0.05, 0.4, 0.01, 0.02, -0.015).finished()); }

/// A mount beside the true one, so that the camera is turned by roll, pitch and yaw from it, degrees.
inline SE3 wrong_mount(const Eigen::Vector3d& turn_deg) {
  Vector6 xi = Vector6::Zero();
  xi.tail<3>() = turn_deg * kDegree;
  return true_mount() * SE3::exp(xi).inverse();
}

/// Where a robot is that drives in curves of about 3 m, at 1 m/s.
inline SE3 driven(double seconds) {
  SE3 T;
  constexpr double kStep = 0.02;
  for (double t = 0; t + 0.5 * kStep < seconds; t += kStep)
    T = T * SE3::exp((Vector6() << kStep, 0, 0, 0, 0, kStep * (0.33 + 0.4 * std::sin(0.9 * t))).finished());
  return SE3(Eigen::Quaterniond::Identity(), {0, -3, 0}) * T;
}

/// A room of 20 × 16 × 3.5 m whose walls, floor and ceiling are speckled, as a camera in it sees it.
class TexturedRoom {
 public:
  [[nodiscard]] Image see(const cameras::CameraModel& camera, const SE3& T_odom_base, Time stamp) const {
    Image image;
    image.stamp = stamp;
    image.resize(PixelFormat::kMono8, camera.width(), camera.height());
    const SE3 T = T_odom_base * true_mount() * cameras::T_camera_optical();
    const Eigen::Matrix3d R = T.rotation();
    for (int v = 0; v < camera.height(); ++v)
      for (int u = 0; u < camera.width(); ++u) {
        const auto ray = camera.unproject({u, v});
        const double grey = ray ? grey_of(T.translation(), R * *ray) : 0;
        image.bytes[static_cast<std::size_t>(v * camera.width() + u)] = static_cast<std::byte>(grey);
      }
    return image;
  }

 private:
  /// Where a ray from inside meets the room, and how bright it is there, 0 to 255.
  static double grey_of(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    const Eigen::Vector3d low(-10, -8, -0.2), high(10, 8, 3.3);
    double nearest = 1e9;
    Eigen::Index wall = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double side = ray[axis] > 0 ? high[axis] : low[axis];
      const double far = std::abs(ray[axis]) > 1e-9 ? (side - from[axis]) / ray[axis] : 1e9;
      if (far < nearest) nearest = far, wall = axis;
    }
    const Eigen::Vector3d place = from + nearest * ray;
    const double a = place[(wall + 1) % 3], b = place[(wall + 2) % 3];
    return 30 + 120 * speckle(a / 0.5, b / 0.5, wall) + 80 * speckle(a / 0.2, b / 0.2, wall + 3);
  }
  /// Smooth noise between 0 and 1, with a grain of 1.
  static double speckle(double a, double b, Eigen::Index kind) {
    const double i = std::floor(a), j = std::floor(b), x = smooth(a - i), y = smooth(b - j);
    return (1 - y) * ((1 - x) * grain(i, j, kind) + x * grain(i + 1, j, kind)) +
           y * ((1 - x) * grain(i, j + 1, kind) + x * grain(i + 1, j + 1, kind));
  }
  static double smooth(double x) { return x * x * (3 - 2 * x); }
  static double grain(double i, double j, Eigen::Index kind) {
    auto h =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(i) * 73856093 ^ static_cast<std::int64_t>(j) * 19349663 ^
                                   static_cast<std::int64_t>(kind) * 83492791);
    h ^= h >> 33U;
    h *= 0xff51afd7ed558ccdULL;
    h ^= h >> 33U;
    return static_cast<double>(h & 0xFFFFU) / 65535;
  }
};

}  // namespace cairn::mount::test
