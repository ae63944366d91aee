// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>

#include "hal/se3.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/visual_odometry/feature_tracker.hpp"

namespace cairn::visual_odometry {

/// A point of the surroundings that a feature shows.
struct Landmark {
  Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m², in odom, against the keyframe that saw it first
  float epoch = 0;                                       ///< see odometry::DriftHistory
};

/// How well a feature's pixel and disparity are known, 1 σ.
struct PixelNoise {
  double pixel = 0.5, disparity = 0.5;  ///< pixels
  [[nodiscard]] Eigen::Vector3d variances() const { return {pixel * pixel, pixel * pixel, disparity * disparity}; }
};

/// Landmarks by the id of their feature.
class LandmarkMap {
 public:
  LandmarkMap(const stereo::StereoGeometry& geometry, const PixelNoise& noise, double max_depth_m)
      : geometry_(geometry), noise_(noise), least_disparity_(geometry.fx * geometry.baseline_m / max_depth_m) {}

  /// Null where the feature has none.
  [[nodiscard]] const Landmark* find(std::uint32_t id) const;
  /// Begins a landmark, if the feature has a disparity that says something.
  void add(const Feature& feature, const SE3& T_odom_eye, float epoch);
  /// Takes a landmark that was known before.
  void take(std::uint32_t id, const Landmark& landmark) { landmarks_.insert_or_assign(id, landmark); }
  /// Puts a landmark to where it is now known to be, with what uncertainty. Unknown ids are ignored.
  void move(std::uint32_t id, const Eigen::Vector3d& p_odom, const Eigen::Matrix3d& covariance);
  void forget(std::uint32_t id) { landmarks_.erase(id); }
  /// Forgets those that no feature shows any more.
  void keep(std::span<const Feature> features);
  void clear() { landmarks_.clear(); }
  [[nodiscard]] std::size_t size() const { return landmarks_.size(); }

 private:
  stereo::StereoGeometry geometry_;
  PixelNoise noise_;
  double least_disparity_;
  std::unordered_map<std::uint32_t, Landmark> landmarks_;
};

}  // namespace cairn::visual_odometry
