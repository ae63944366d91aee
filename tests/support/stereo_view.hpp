// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>

#include "hal/image.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/perception/stereo/stereo_pair.hpp"
#include "tests/support/box_world.hpp"

namespace cairn::support {

/// 0…1, smooth, with details of about `cell_m`; the same everywhere and for ever.
inline double texture(const Eigen::Vector3d& p, double cell_m) {
  const auto corner = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    auto h = static_cast<std::uint64_t>(x * 73856093 ^ y * 19349663 ^ z * 83492791);
    h = (h ^ (h >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    return static_cast<double>((h ^ (h >> 27U)) >> 40U) / static_cast<double>(1U << 24U);
  };
  const Eigen::Vector3d q = p / cell_m;
  const Eigen::Vector3d low = q.array().floor();
  const Eigen::Vector3d t = q - low;
  const Eigen::Vector3d s = t.array().square() * (3 - 2 * t.array());
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = i >> 1 & 1, z = i >> 2 & 1;
    const double weight = (x ? s.x() : 1 - s.x()) * (y ? s.y() : 1 - s.y()) * (z ? s.z() : 1 - s.z());
    sum += weight * corner(static_cast<std::int64_t>(low.x()) + x, static_cast<std::int64_t>(low.y()) + y,
                           static_cast<std::int64_t>(low.z()) + z);
  }
  return sum;
}

/// A stereo camera in a World whose surfaces are painted with texture(): grey pictures with known noise.
class StereoView {
 public:
  StereoView(const World& world, const stereo::StereoGeometry& geometry, unsigned seed)
      : world_(world), geometry_(geometry), noise_(seed) {}

  /// What both eyes see from where the left one is (optical frame).
  void shoot(const SE3& T_world_eye, Time stamp, stereo::StereoPair& pair) {
    shoot([&](double) { return T_world_eye; }, stamp, pair);
  }
  /// The same with a rolling shutter: where the left eye is, so many seconds after the stamp.
  void shoot(const std::function<SE3(double)>& T_world_eye, Time stamp, stereo::StereoPair& pair) {
    const SE3 T_left_right(Eigen::Quaterniond::Identity(), {geometry_.baseline_m, 0, 0});
    pair.stamp = stamp;
    expose(T_world_eye, pair.left);
    expose([&](double after_s) { return T_world_eye(after_s) * T_left_right; }, pair.right);
  }

  /// Both eyes side by side.
  static Image side_by_side(const stereo::StereoPair& pair) {
    Image both;
    both.resize(PixelFormat::kMono8, 2 * pair.left.width, pair.left.height);
    both.stamp = pair.stamp;
    for (int y = 0; y < pair.left.height; ++y) {
      const auto left = pair.left.view().row(y), right = pair.right.view().row(y);
      std::ranges::copy(left, both.bytes.begin() + static_cast<std::ptrdiff_t>(y) * 2 * pair.left.width);
      std::ranges::copy(right,
                        both.bytes.begin() + static_cast<std::ptrdiff_t>(y) * 2 * pair.left.width + pair.left.width);
    }
    return both;
  }

 private:
  void expose(const std::function<SE3(double)>& T_world_eye_at, Image& image) {
    std::normal_distribution<double> noise(0, 1.3);
    image.resize(PixelFormat::kMono8, geometry_.width, geometry_.height);
    for (int v = 0; v < geometry_.height; ++v) {
      const SE3 T_world_eye = T_world_eye_at(geometry_.after_stamp_s(v));
      const Eigen::Matrix3d R = T_world_eye.rotation();
      for (int u = 0; u < geometry_.width; ++u) {
        const Eigen::Vector3d ray((u - geometry_.cx) / geometry_.fx, (v - geometry_.cy) / geometry_.fy, 1);
        const Eigen::Vector3d d = R * ray.normalized();
        const double range = world_.cast(T_world_eye.translation(), d);
        const Eigen::Vector3d p = T_world_eye.translation() + std::min(range, 1e3) * d;
        const double grey = 40 + 110 * texture(p, 0.25) + 70 * texture(p, 0.07) + noise(noise_);
        image.bytes[static_cast<std::size_t>(v) * image.stride + static_cast<std::size_t>(u)] =
            static_cast<std::byte>(std::clamp(std::lround(grey), 0L, 255L));
      }
    }
  }

  const World& world_;
  stereo::StereoGeometry geometry_;
  std::mt19937 noise_;
};

/// A small camera whose pictures are quick to render.
inline stereo::StereoGeometry small_eyes() {
  return {
      .width = 256, .height = 160, .fx = 136, .fy = 136, .cx = 127.5, .cy = 79.5, .baseline_m = 0.12, .line_time_s = 0};
}

/// 10 m × 8 m × 3 m with two boxes on the floor, seen from inside.
inline World furnished_room() {
  World world;
  world.box({-5, -4, 0}, {5, 4, 3}).box({2, -3, 0}, {3, -2, 1.2}).box({2.5, 1, 0}, {3.5, 2.5, 0.8});
  return world;
}

}  // namespace cairn::support
