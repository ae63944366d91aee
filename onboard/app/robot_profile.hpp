// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/velodyne/config.hpp"
#include "hal/config.hpp"
#include "hal/result.hpp"
#include "onboard/robot.hpp"

namespace cairn {

/// How a LiDAR is mounted and spoken to.
struct LidarProfile {
  velodyne::Config driver;
  std::vector<double> base_xyz_rpy{0, 0, 0, 0, 0, 0};  ///< T_base_lidar: x y z [m], roll pitch yaw [rad], fixed axes
};

/// Everything that is said about one robot: config/husky.yaml and its like.
struct RobotProfile {
  std::string name = "robot";
  LidarProfile lidar;
  OdometryConfig odometry;
  MappingConfig mapping;
  double odometry_deadline_s = 0.08;  ///< live: no further refinement of a pose this long after its last packet
  int threads = 1;

  [[nodiscard]] RobotConfig robot() const;
};

void declare(config::Section& section, LidarProfile& profile);
void declare(config::Section& section, RobotProfile& profile);

/// Defaults where `path` is empty; otherwise the file, with every fault reported at once.
Result<RobotProfile> load_profile(const std::filesystem::path& path);
/// The effective values as YAML, as they are kept with every run.
[[nodiscard]] std::string to_yaml(RobotProfile profile);

}  // namespace cairn
