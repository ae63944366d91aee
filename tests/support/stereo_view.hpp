// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <random>

#include "hal/image.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/perception/stereo/stereo_pair.hpp"
#include "tests/support/box_world.hpp"

namespace cairn::support {

/// 0…1, smooth, with details of about `cell_m`; the same everywhere and for ever.
[[nodiscard]] double texture(const Eigen::Vector3d& p, double cell_m);

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
  void expose(const std::function<SE3(double)>& T_world_eye_at, Image& image);

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
