// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "hal/workers.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/drift_history.hpp"
#include "onboard/odometry/local_map/patch_map.hpp"
#include "onboard/odometry/recent_scans.hpp"

namespace cairn::odometry {

/// The surroundings as the last scans showed them: patches within `window_m` of the robot, and how
/// uncertain the pose was when each of them was made. Covariances are those of a left perturbation
/// of T_odom_base.
class LocalMap {
 public:
  /// `T_base_lidar` takes a point of the sensor to base_link. `workers` must outlive the map.
  LocalMap(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers);

  /// Forgets everything. A new map begins with the next scan.
  void begin(const SE3& T_odom_base, const Matrix6& covariance);
  /// Adds those points of a placed scan that `chosen` names, forgets what is far behind, begins a
  /// new epoch of the drift when the robot has moved enough. `points_base` in base_link, in metres.
  void insert(std::span<const Eigen::Vector3f> points_base, std::span<const std::uint32_t> chosen,
              const SE3& T_odom_base, const Matrix6& covariance, Time stamp);
  /// Adds all points of a scan that a previous run placed. It does not count towards settled().
  void restore(const PlacedScan& scan, const Matrix6& covariance);

  /// The map was begun at least `settling_scans` scans ago: its first scan, taken in an unknown
  /// motion, is outweighed.
  [[nodiscard]] bool settled() const { return scans_ >= settling_scans_; }
  /// Covariance with which the patches in use were placed.
  [[nodiscard]] Matrix6 drift(std::span<const KeypointUse> uses) { return drift_.average(uses); }
  [[nodiscard]] const PatchMap& patches() const { return patches_; }

 private:
  void add(const SE3& T_odom_base, const Matrix6& covariance, Time stamp);
  void prune(const SE3& T_odom_base);

  SE3 T_base_lidar_;
  Workers& workers_;
  double window_m_;
  int settling_scans_;

  PatchMap patches_;
  DriftHistory drift_;
  SE3 T_odom_pruned_;          // where the base was when the map was last pruned
  int scans_ = 0;              // inserted since begin()
  std::optional<Time> begun_;  // stamp of the first scan
  std::vector<Eigen::Vector3d> points_odom_;
};

}  // namespace cairn::odometry
