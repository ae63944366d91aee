// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config/config.hpp"

namespace cairn {

/// Settings of LidarOdometry. The defaults suit wheeled robots and slow drones with a spinning 16…64-beam LiDAR.
struct OdometryConfig {
  double min_range_m = 0.5;
  double max_range_m = 100.0;

  double insert_spacing_m = 0.05;
  int keypoints = 2500;
  int max_iterations = 12;

  double finest_block_m = 0.5;
  double window_m = 80.0;
  int max_blocks = 1 << 16;
  int max_points_per_block = 400;

  double noise_floor_m = 0.01;
  double max_thickness_m = 0.06;
  double correlation_factor = 40.0;

  double linear_acceleration = 1.0;
  double angular_acceleration = 1.0;
  double initial_speed = 10.0;
  double initial_angular_speed = 1.0;
  double max_speed = 50.0;
  double max_angular_speed = 6.0;

  double max_gap_s = 1.0;
  double min_inlier_ratio = 0.4;
  int min_matches = 60;
  double min_facing_points = 10.0;
  int reinitialise_after = 10;
};

/// Names, units and bounds of every key (config section `odometry`).
void declare(config::Section& section, OdometryConfig& c);

}  // namespace cairn
