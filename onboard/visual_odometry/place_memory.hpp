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
#include "hal/time.hpp"
#include "onboard/visual_odometry/feature_tracker.hpp"
#include "onboard/visual_odometry/landmark_map.hpp"
#include "onboard/visual_odometry/pose_solver.hpp"

namespace cairn::visual_odometry {

/// What a patch looks like: 256 comparisons of smoothed pixels around it (Calonder et al., BRIEF, 2010). Patches must
/// stand upright to compare, as those of robots do.
using Descriptor = std::array<std::uint64_t, 4>;

/// Where a patch is, and how large: 1 reaches 15 pixels from its middle.
struct Spot {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  float scale = 1;
};

/// One descriptor for each spot, in its order. `picture`: kMono8.
[[nodiscard]] std::vector<Descriptor> describe(const Image& picture, std::span<const Spot> spots);

/// What a keyframe showed: enough to know the place again.
struct Keyframe {
  Time stamp{};                         ///< of its picture
  SE3 T_odom_base;                      ///< where the robot was
  std::vector<Descriptor> descriptors;  ///< of its patches
  std::vector<Landmark> landmarks;      ///< one for each descriptor
};

/// Remembers what the last keyframes showed, to find a robot again that has lost its way: after darkness, after blur,
/// or when somebody covered the lens. Both eyes tell how far a corner is. So patches are of the same size in metres,
/// and look alike from near and far.
class PlaceMemory {
 public:
  explicit PlaceMemory(double baseline_m) : baseline_m_(baseline_m) {}

  static constexpr std::size_t kPlaces = 10;  ///< keyframes that are remembered; they take 30 kB each

  /// A place where the robot may be: landmarks that the picture seems to show.
  struct Place {
    SE3 T_odom_base;  ///< of the keyframe
    std::vector<Match> matches;
  };

  /// Remembers a keyframe: its picture, its features, and their landmarks.
  void remember(Time stamp, const Image& left, std::span<const Feature> features, const LandmarkMap& landmarks,
                const SE3& T_odom_base);
  /// Takes a keyframe back that was remembered before.
  void restore(Keyframe keyframe);
  /// Null: there is none.
  [[nodiscard]] const Keyframe* newest() const { return keyframes_.empty() ? nullptr : &keyframes_.back(); }
  /// The remembered keyframe that shares most with this picture. Without matches where none shares enough.
  [[nodiscard]] Place recall(const Image& left, std::span<const Feature> features) const;
  void clear() { keyframes_.clear(); }

 private:
  [[nodiscard]] std::vector<Descriptor> describe_all(const Image& left, std::span<const Feature> features) const;

  double baseline_m_;
  std::deque<Keyframe> keyframes_;  // the newest last
};

}  // namespace cairn::visual_odometry
