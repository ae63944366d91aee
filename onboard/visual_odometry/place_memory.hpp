// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "hal/image.hpp"
#include "hal/se3.hpp"
#include "onboard/visual_odometry/feature_tracker.hpp"
#include "onboard/visual_odometry/landmark_map.hpp"
#include "onboard/visual_odometry/pose_solver.hpp"

namespace cairn::visual_odometry {

/// What a patch looks like: 256 comparisons of smoothed pixels around it (Calonder et al., BRIEF, 2010). Patches must
/// stand upright to compare, as those of robots do.
using Descriptor = std::array<std::uint64_t, 4>;

/// One descriptor for each pixel, in its order. `picture`: kMono8.
[[nodiscard]] std::vector<Descriptor> describe(const Image& picture, std::span<const Eigen::Vector2f> pixels);

/// Remembers what the last keyframes showed, to find a robot again that has lost its way: after darkness, after blur,
/// or when somebody covered the lens.
class PlaceMemory {
 public:
  static constexpr std::size_t kPlaces = 10;  ///< keyframes that are remembered; they take 30 kB each

  /// A place where the robot may be: landmarks that the picture seems to show.
  struct Place {
    SE3 T_odom_base;  ///< of the keyframe
    std::vector<Match> matches;
  };

  /// Remembers a keyframe: its picture, its features, and their landmarks.
  void remember(const Image& left, std::span<const Feature> features, const LandmarkMap& landmarks,
                const SE3& T_odom_base);
  /// The remembered keyframe that shares most with this picture. Without matches where none shares enough.
  [[nodiscard]] Place recall(const Image& left, std::span<const Feature> features) const;
  void clear() { keyframes_.clear(); }

 private:
  struct Keyframe {
    SE3 T_odom_base;
    std::vector<Descriptor> descriptors;
    std::vector<Landmark> landmarks;  // one per descriptor
  };
  std::deque<Keyframe> keyframes_;  // the newest last
};

}  // namespace cairn::visual_odometry
