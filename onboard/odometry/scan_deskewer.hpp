// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/odometry/scan_preparation.hpp"

namespace cairn::odometry {

/// Deskews whole scans, see Deskew. Keeps its memory between calls.
class ScanDeskewer {
 public:
  /// `T_base_lidar` takes a point of the sensor to base_link. `workers` must outlive the deskewer.
  ScanDeskewer(const SE3& T_base_lidar, Workers& workers) : T_base_lidar_(T_base_lidar), workers_(workers) {}

  /// All points of the scan, in its order, in base_link at its stamp, for a base that moved with
  /// `twist` (m/s, rad/s, of base_link in base_link).
  void deskew(const PreparedScan& scan, const Vector6& twist);
  /// Of the last deskew(), in metres; valid until the next.
  [[nodiscard]] std::span<const Eigen::Vector3f> points_base() const { return points_base_; }

 private:
  SE3 T_base_lidar_;
  Workers& workers_;
  std::vector<Eigen::Vector3f> points_base_;
};

}  // namespace cairn::odometry
