// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/config.hpp"

namespace cairn {
namespace {

void declare_points(config::Section& s, OdometryConfig& c) {
  s.number("min_range_m", c.min_range_m, {0.0, 10.0}, "m", "nearer points are not used");
  s.number("max_range_m", c.max_range_m, {1.0, 300.0}, "m", "farther points are not used");
  s.number("insert_spacing_m", c.insert_spacing_m, {0.01, 2.0}, "m", "a scan adds one point per such cube to the map");
  s.integer("keypoints", c.keypoints, {100, 20000}, "", "points to register; twice as many is the cap");
}

void declare_map(config::Section& s, OdometryConfig& c) {
  s.number("finest_block_m", c.finest_block_m, {0.1, 4.0}, "m", "edge of the smallest patches; others: 2 and 4 times");
  s.number("window_m", c.window_m, {5.0, 300.0}, "m", "radius around the robot in which the map is kept");
  s.integer("max_blocks", c.max_blocks, {1024, 1 << 20}, "", "blocks in each of the two finest of six grids");
  s.integer("max_points_per_block", c.max_points_per_block, {20, 100000}, "", "a block with so many is final");
  s.number("noise_floor_m", c.noise_floor_m, {0.001, 0.2}, "m", "smallest believed deviation of a point from a plane");
  s.number("max_thickness_m", c.max_thickness_m, {0.005, 0.5}, "m", "thicker patches are not planes");
}

void declare_weights(config::Section& s, OdometryConfig& c) {
  s.integer("max_iterations", c.max_iterations, {1, 50}, "", "cap per scan; the budget may grant fewer");
  s.number("correlation", c.correlation, {1.0, 1000.0}, "", "neighbouring points err alike: so many count as one");
  s.number("drift_factor", c.drift_factor, {1.0, 10000.0}, "", "variance of the drift over that of independent points");
  s.number("min_facing_points", c.min_facing_points, {1.0, 1000.0}, "", "a direction that fewer face is degenerate");
}

void declare_motion(config::Section& s, OdometryConfig& c) {
  s.number("horizontal_acceleration", c.horizontal_acceleration, {0.01, 100.0}, "m/s2", "standard deviation, x and y");
  s.number("vertical_acceleration", c.vertical_acceleration, {0.01, 100.0}, "m/s2", "standard deviation, z");
  s.number("turning_acceleration", c.turning_acceleration, {0.01, 100.0}, "rad/s2", "standard deviation, about z");
  s.number("tilting_acceleration", c.tilting_acceleration, {0.01, 100.0}, "rad/s2",
           "standard deviation, about x and y");
  s.number("initial_speed", c.initial_speed, {0.01, 50.0}, "m/s", "standard deviation of an unknown speed");
  s.number("initial_turning_rate", c.initial_turning_rate, {0.01, 10.0}, "rad/s", "standard deviation when unknown");
  s.number("max_speed", c.max_speed, {0.1, 100.0}, "m/s", "a faster motion is not believed");
  s.number("max_turning_rate", c.max_turning_rate, {0.1, 50.0}, "rad/s", "a faster turn is not believed");
}

void declare_limits(config::Section& s, OdometryConfig& c) {
  s.number("max_gap_s", c.max_gap_s, {0.05, 60.0}, "s", "after a longer gap the motion is not extrapolated");
  s.number("min_inlier_ratio", c.min_inlier_ratio, {0.0, 1.0}, "", "lost if a smaller share of matched points fits");
  s.integer("min_matches", c.min_matches, {6, 10000}, "", "lost if fewer points lie near patches");
  s.integer("reinitialise_after", c.reinitialise_after, {1, 1000}, "", "lost scans in a row before a new map is begun");
}

}  // namespace

void declare(config::Section& section, OdometryConfig& c) {
  declare_points(section, c);
  declare_map(section, c);
  declare_weights(section, c);
  declare_motion(section, c);
  declare_limits(section, c);
}

}  // namespace cairn
