// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>

#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::mount {

/// One place that a camera saw twice: unit vectors in its body frame (x along the view, y left, z up).
struct Sighting {
  Eigen::Vector3d before = Eigen::Vector3d::UnitX(), now = before;
};

/// What is assumed of the noise.
struct EstimatorConfig {
  double sight_rad = 1e-3;        ///< rad, 1 σ of a direction: 0.35 pixels of a camera with a focal length of 350
  double inverse_depth = 0.2;     ///< 1/m, expected of a place
  double inverse_depth_sd = 0.2;  ///< 1/m, 1 σ
  Duration window = std::chrono::seconds(12);  ///< older pairs of pictures do not count
  Duration block = std::chrono::seconds(1);    ///< pairs of so long err in common; by how blocks differ σ is told
};

/// How far a camera is turned from how its mount says, by what it saw while the robot moved: the way that odometry
/// knows has to explain how places move through the pictures. Driving on tells pitch and yaw, turning tells the two
/// axes that are square to the turn's.
class MountEstimator {
 public:
  /// The true mount is T_base_camera · exp(turn).
  struct Estimate {
    Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();        ///< roll, pitch, yaw: about the camera's x, y and z
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< rad²; by how the window's blocks differ
    [[nodiscard]] double deviation_rad(Eigen::Index axis) const { return std::sqrt(covariance(axis, axis)); }
  };

  explicit MountEstimator(const SE3& T_base_camera, const EstimatorConfig& config = {});

  /// What two pictures have in common; the newer one was taken at `stamp`. `T_before_now`: of base_link, between the
  /// exposures.
  void add(Time stamp, const SE3& T_before_now, std::span<const Sighting> sightings);
  void clear() { blocks_.clear(); }

  /// None: too little was seen.
  [[nodiscard]] std::optional<Estimate> estimate() const;
  /// Pairs of pictures in the window.
  [[nodiscard]] std::size_t pairs() const;

 private:
  /// Normal equations of the turn, of all pairs of a block.
  struct Block {
    Time begin{};
    std::size_t pairs = 0;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  };

  SE3 T_base_camera_;
  EstimatorConfig config_;
  std::deque<Block> blocks_;
};

}  // namespace cairn::mount
