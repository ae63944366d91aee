// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config.hpp"

namespace cairn {

/// Settings of LidarOdometry. The defaults suit wheeled robots and slow drones with a spinning 16…64-beam LiDAR.
struct OdometryConfig {
  // Which points
  double min_range_m = 0.5;       ///< nearer points are not used: the robot itself, dust
  double max_range_m = 100.0;     ///< nor are farther ones
  double insert_spacing_m = 0.1;  ///< a scan adds one point per cube of this edge to the map
  int keypoints = 2500;           ///< points to register; their spacing adapts, twice as many is the cap

  // The map of the recent past
  double finest_block_m = 0.5;     ///< edge of the smallest patches; the others have 2 and 4 times this
  double window_m = 80.0;          ///< radius around the robot in which the map is kept
  int max_blocks = 1 << 16;        ///< bound on memory: blocks in each of the two finest of six grids
  int max_points_per_block = 400;  ///< a block that has seen so many points does not change any more
  double noise_floor_m = 0.01;     ///< smallest standard deviation of a point-to-plane distance that is believed
  double max_thickness_m = 0.06;   ///< patches with a larger standard deviation across are not planes

  // Weighing a scan against the prediction
  int max_iterations = 12;          ///< cap per scan; the budget may grant fewer
  double correlation = 5.0;         ///< neighbouring points err alike: so many count as one
  double drift_factor = 30.0;       ///< variance of the drift over that of as many independent points
  double min_facing_points = 10.0;  ///< a direction is degenerate if fewer points look at a surface facing it

  // How the robot moves: standard deviations of its acceleration in base_link
  double horizontal_acceleration = 3.0;  ///< along x and y [m/s²]
  double vertical_acceleration = 1.0;    ///< along z [m/s²]
  double turning_acceleration = 3.0;     ///< about z [rad/s²]
  double tilting_acceleration = 1.0;     ///< about x and y [rad/s²]
  double initial_speed = 3.0;            ///< standard deviation of the speed when nothing is known of it [m/s]
  double initial_turning_rate = 1.0;     ///< the same for rotations [rad/s]
  double max_speed = 50.0;               ///< a faster motion is not believed [m/s]
  double max_turning_rate = 6.0;         ///< nor is a faster turn [rad/s]

  // When to give up
  double max_gap_s = 1.0;         ///< after a longer gap between scans the motion is not extrapolated
  double min_inlier_ratio = 0.4;  ///< lost if a smaller share of the points near patches lies on them
  int min_matches = 60;           ///< lost if fewer points lie near patches
  int reinitialise_after = 10;    ///< lost scans in a row before a new map is begun
};

/// Names, units and bounds of every key (config section `odometry`).
void declare(config::Section& section, OdometryConfig& c);

}  // namespace cairn
