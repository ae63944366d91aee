// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/config.hpp"

namespace cairn::odometry {
namespace {

void declare_registration(config::Section& s, OdometryConfig& c) {
  s.number("min_range_m", c.min_range_m, {0.0, 10.0}, "m", "nearer points are not used for registration or the map");
  s.number("max_range_m", c.max_range_m, {1.0, 300.0}, "m", "farther points are not used for registration or the map");
  s.number("insert_spacing_m", c.insert_spacing_m, {0.01, 2.0}, "m",
           "a scan adds one point per cube of this edge to the map");
  s.integer("keypoints", c.keypoints, {100, 20000}, "",
            "points to register; the spacing adapts, twice as many is the cap");
  s.integer("max_iterations", c.max_iterations, {1, 50}, "", "cap per scan; the budget may grant fewer");
  s.number("narrowest_gate_m", c.narrowest_gate_m, {0.01, 0.5}, "m",
           "the last iterations match a point with patches that are not farther away");
  s.number("widest_gate_m", c.widest_gate_m, {0.5, 10.0}, "m",
           "the first iteration matches a point with patches that are not farther away");
}

void declare_map(config::Section& s, OdometryConfig& c) {
  s.number("finest_block_m", c.finest_block_m, {0.1, 4.0}, "m",
           "edge of the smallest plane patches; the others have 2 and 4 times this");
  s.number("window_m", c.window_m, {5.0, 300.0}, "m", "radius around the robot in which the map is kept");
  s.integer("max_blocks", c.max_blocks, {1024, 1 << 20}, "",
            "bound on the map's memory: blocks in each of the two finest grids");
  s.integer("max_points_per_block", c.max_points_per_block, {20, 100000}, "",
            "a block that has seen so many points does not change any more");
  s.number("lasting_s", c.lasting_s, {0.0, 60.0}, "s",
           "a surface that has been seen for less time is fresh: it confirms the motion it was made with");
  s.number("fresh_share", c.fresh_share, {0.001, 1.0}, "",
           "share of its weight that a point on a fresh wall or pole counts");
  s.number("noise_floor_m", c.noise_floor_m, {0.001, 0.2}, "m",
           "smallest standard deviation of a point-to-plane distance that is believed");
  s.number("max_thickness_m", c.max_thickness_m, {0.005, 0.5}, "m", "thicker patches are not planes");
}

void declare_motion(config::Section& s, OdometryConfig& c) {
  s.number("correlation_factor", c.correlation_factor, {1.0, 1000.0}, "",
           "points per independent piece of information: errors of neighbouring points are alike");
  s.number("linear_acceleration", c.linear_acceleration, {0.01, 100.0}, "m/s2",
           "standard deviation of the robot's acceleration. Less is steadier: a wrong motion within a scan and the map "
           "that is made with it confirm each other");
  s.number("angular_acceleration", c.angular_acceleration, {0.01, 100.0}, "rad/s2",
           "standard deviation of the robot's angular acceleration, likewise");
  s.integer("settling_scans", c.settling_scans, {0, 1000}, "",
            "scans of a new map during which the accelerations count settling_noise_factor times");
  s.number("settling_noise_factor", c.settling_noise_factor, {1.0, 100.0}, "",
           "times both accelerations while a map is new: its first scan was taken in an unknown motion");
  s.number("initial_speed", c.initial_speed, {0.0, 50.0}, "m/s",
           "standard deviation of the speed before the second scan");
  s.number("initial_angular_speed", c.initial_angular_speed, {0.0, 10.0}, "rad/s",
           "standard deviation of the turning rate before the second scan");
  s.number("max_speed", c.max_speed, {0.1, 100.0}, "m/s", "a faster motion is not believed");
  s.number("max_angular_speed", c.max_angular_speed, {0.1, 50.0}, "rad/s", "a faster turn is not believed");
}

void declare_tracking(config::Section& s, OdometryConfig& c) {
  s.number("min_inlier_ratio", c.min_inlier_ratio, {0.0, 1.0}, "",
           "lost if a smaller share of the points near planes lies on them");
  s.integer("min_matches", c.min_matches, {6, 10000}, "", "lost if fewer points lie near planes");
  s.number("min_facing_points", c.min_facing_points, {1.0, 1000.0}, "",
           "a direction is degenerate if fewer points look at a surface that faces it");
  s.integer("reinitialise_after", c.reinitialise_after, {1, 1000}, "",
            "lost scans in a row before a new map begins, on a robot with wheel odometry");
  s.integer("give_up_after", c.give_up_after, {1, 10000}, "",
            "lost scans in a row before a new map begins, on a robot without wheel odometry");
}

}  // namespace

void declare(config::Section& s, OdometryConfig& c) {
  declare_registration(s, c);
  declare_map(s, c);
  declare_motion(s, c);
  declare_tracking(s, c);
  s.group("start_search", c.start_search, "where registration begins when the prediction says little");
  s.group("agility", c.agility, "how much acceleration is expected of a robot that jerks");
  s.group("second_look", c.second_look, "when a fit is doubted and a better one is looked for");
  s.group("restart", c.restart, "where a restarted robot may be");
}

void declare(config::Section& s, StartSearchConfig& c) {
  s.number("unknown_speed_m_s", c.unknown_speed_m_s, {0.1, 100.0}, "m/s",
           "standard deviation of the predicted speed above which a new map's first scans try speeds one by one");
  s.number("speed_gate_m", c.speed_gate_m, {0.01, 10.0}, "m", "a point fits a speed if it is that near to its patch");
  s.number("unknown_heading_rad", c.unknown_heading_rad, {0.01, 10.0}, "rad",
           "standard deviation of the predicted heading above which a restarted robot is searched for");
  s.number("gap_gate_m", c.gap_gate_m, {0.01, 10.0}, "m",
           "a point fits a heading or a position if it is that near to its patch");
}

void declare(config::Section& s, AgilityConfig& c) {
  s.number("gain", c.gain, {0.0, 10.0}, "",
           "share of an acceleration just seen that the next scans are expected to have");
  s.number("decay", c.decay, {0.0, 1.0}, "", "share of that expectation that is left after each scan");
  s.number("most_m_s2", c.most_m_s2, {0.01, 100.0}, "m/s2", "more acceleration is not expected");
  s.number("most_rad_s2", c.most_rad_s2, {0.01, 1000.0}, "rad/s2", "more angular acceleration is not expected");
  s.number("any_way_m", c.any_way_m, {0.0, 10.0}, "m",
           "standard deviation of the way from a steady motion, where anything may have happened");
  s.number("any_speed_m_s", c.any_speed_m_s, {0.0, 50.0}, "m/s", "is added to any_way_m for each second");
  s.number("any_tilt_rad", c.any_tilt_rad, {0.001, 3.0}, "rad", "the same for roll and pitch, after any time");
  s.number("any_heading_rad", c.any_heading_rad, {0.001, 3.0}, "rad", "the same for the heading");
  s.number("any_turn_rad_s", c.any_turn_rad_s, {0.0, 50.0}, "rad/s", "is added to any_heading_rad for each second");
}

void declare(config::Section& s, SecondLookConfig& c) {
  s.number("doubtful_share", c.doubtful_share, {0.0, 1.0}, "",
           "a fit is doubted if fewer points fit than this share of what is usual");
  s.number("blurred_share", c.blurred_share, {0.0, 1.0}, "",
           "a scan is not added to the map if fewer points fit than this share of what is usual");
  s.number("unsure_after_s", c.unsure_after_s, {0.0, 60.0}, "s",
           "after a longer time without a scan that fits, only a fit nearly as good as usual is believed");
  s.number("sure_share", c.sure_share, {0.0, 1.0}, "",
           "after unsure_after_s, a scan must reach this part of the usual share of fitting points");
  s.number("blind_after_s", c.blind_after_s, {0.0, 3600}, "s",
           "after so long without a scan, only a fit that the wheels allow is believed, or one at rest within stood_m");
  s.number("stood_m", c.stood_m, {0.0, 1000}, "m", "radius for blind_after_s");
  s.integer("blind_patience", c.blind_patience, {1, 1000}, "",
            "after blind_after_s, so many lost scans in a row begin a new map");
  s.number("long_step_s", c.long_step_s, {0.0, 60.0}, "s", "after a longer time between scans every fit is doubted");
  s.number("better", c.better, {1.0, 10.0}, "", "times as many points must fit before another place is believed");
  s.integer("keypoints", c.keypoints, {50, 20000}, "", "points to search with");
}

void declare(config::Section& s, RestartConfig& c) {
  s.number("position_m", c.position_m, {0.01, 10.0}, "m", "standard deviation of the position, when at rest before");
  s.number("angle_rad", c.angle_rad, {0.01, 3.0}, "rad", "standard deviation of the angles, when at rest before");
  s.number("speed_m_s", c.speed_m_s, {0.0, 10.0}, "m/s", "standard deviation of the speed now");
  s.number("turn_rad_s", c.turn_rad_s, {0.0, 10.0}, "rad/s", "standard deviation of the turning rate now");
  s.number("braking_s", c.braking_s, {0.0, 10.0}, "s",
           "times the last speed, it adds to the standard deviations of position and angles");
  s.number("coasting_s", c.coasting_s, {0.01, 60.0}, "s", "a longer absence moves the robot no farther");
  s.number("found_share", c.found_share, {0.0, 1.0}, "",
           "the first scan must know this share of what the previous run's last scan knew");
}

}  // namespace cairn::odometry
