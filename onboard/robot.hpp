// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hal/budget.hpp"
#include "hal/monitor.hpp"
#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/mapping/mapper.hpp"
#include "onboard/odometry/odometry.hpp"

namespace cairn {

struct RobotConfig {
  SE3 T_base_lidar;  ///< how the LiDAR is mounted
  OdometryConfig odometry;
  MappingConfig mapping;
};

/// Where the robot was when a scan ended, and how well it knew.
struct TrackPoint {
  Time stamp{};
  UncertainPose T_odom_base;
  int degenerate_directions = 0;  ///< of the motion since the last scan: 0 = all six directions were observed
  int iterations = 0;
  bool lost = false;
};

/// One robot: scans in, trajectory and map out. Deterministic for any number of threads.
class Robot {
 public:
  /// `workers` and `monitor` are borrowed and must outlive the robot.
  Robot(const RobotConfig& config, Workers& workers, Monitor& monitor);

  /// Estimates the motion since the last scan and, when it is trusted, adds the scan to the map.
  /// On an error the scan is dropped, and track and map are as before.
  Result<TrackPoint> step(const Scan& scan, Budget& budget);

  [[nodiscard]] const std::vector<TrackPoint>& track() const { return track_; }
  [[nodiscard]] const SemanticOcTree& map() const { return mapper_.tree(); }

 private:
  Result<OdometryUpdate> locate(const Scan& scan, Budget& budget);
  void extend_map(const OdometryUpdate& motion);

  SE3 T_base_lidar_;
  LidarOdometry odometry_;
  Mapper mapper_;
  Monitor& monitor_;
  std::vector<TrackPoint> track_;
  std::vector<Eigen::Vector3f> points_odom_;  // reused
};

}  // namespace cairn
