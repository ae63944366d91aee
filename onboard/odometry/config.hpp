// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config/config.hpp"

namespace cairn::odometry {

/// When the prediction says too little to begin a registration there, and how other starts are
/// compared.
struct StartSearchConfig {
  /// m/s, standard deviation of the predicted forward speed. Above it, speeds are tried one by one,
  /// in the first three scans of a map. A start at 8 m/s was taken for rest before (KITTI sequence
  /// 00, `odometry_accuracy kitti`).
  double unknown_speed_m_s = 2.0;
  /// m. A keypoint fits a speed if it lies this near to its patch. Half of the speeds' step, times
  /// a scan of 0.1 s, is 0.05 m; the rest is for the turn, which is unknown as well.
  double speed_gate_m = 0.5;
  /// rad, standard deviation of the predicted heading. Above it, the neighbourhood of a restarted
  /// robot is searched. A robot that stood still when its program ended is below.
  double unknown_heading_rad = 0.12;
  /// m. A keypoint fits a hypothesis of that search if it lies this near to its patch. As
  /// `narrowest_gate_m`.
  double gap_gate_m = 0.2;
};

/// How much acceleration is expected of a robot that jerks. Found with `cairn simulate --motion
/// aggressive` and `handheld`, seeds 1 and 2 (`odometry_drives`): 3 m/s and 120°/s that begin and
/// end within 0.1 s, and a sensor that nods with every step.
struct AgilityConfig {
  /// Share of an acceleration just seen that the next steps are expected to have, as a standard
  /// deviation.
  double gain = 0.7;
  double decay = 0.9;       ///< per scan, of what was seen
  double most_m_s2 = 10;    ///< m/s². More is not expected: a car's tyres hold that.
  double most_rad_s2 = 25;  ///< rad/s². 120°/s within 0.1 s, and a little.
  // What may have happened since the last scan that was followed: standard deviations of the
  // difference to a steady motion. At 10 Hz they reach 31° and 0.45 m, after half a second 113° and
  // 1.6 m.
  double any_way_m = 0.05;        ///< m, plus any_speed_m_s for each second
  double any_speed_m_s = 1.0;     ///< m/s
  double any_tilt_rad = 0.2;      ///< rad, of roll and pitch, after any time: robots stay upright
  double any_heading_rad = 0.06;  ///< rad, plus any_turn_rad_s for each second
  double any_turn_rad_s = 1.2;    ///< rad/s
};

/// When a fit is doubted, and how a better one is looked for. Found as AgilityConfig.
struct SecondLookConfig {
  /// Of the usual share of keypoints that fit, floors and ceilings not counted. A turn of 120°/s
  /// that began within a scan brought it to 0.8 in a simulated car park.
  double doubtful_share = 0.93;
  /// Of the same usual share. A scan that fits worse is followed but not added to the map: it was
  /// deskewed badly. Without this, four walks of 40 s had 49 lost scans, with 0.85 they had
  /// 167, with this none.
  double blurred_share = 0.7;
  /// s. After a longer time only a fit nearly as good as usual is believed: others are often places that look alike.
  double unsure_after_s = 1.0;
  /// Of the usual share, for that. Wrong fits after 5 s had 0.67 to 0.81 (odometry_drives gap=5), right ones 0.94.
  double sure_share = 0.87;
  /// s. If no scan came for longer, and no wheels tell the motion, one scan cannot tell where the robot is: in
  /// simulated offices and streets, 1 of 32 gaps of 4 s led to a place that looks alike, and at least 8 of 32 gaps of
  /// 10 s. Wheels tell, but not if they exclude the place: a room that looks alike, 13 m off in an office.
  double blind_after_s = 3;
  /// m. Where nothing tells, only a robot that is so near to where it was is believed to be there: it stood, or turned.
  double stood_m = 1;
  int blind_patience = 3;     ///< then so many lost scans in a row begin a new map
  double long_step_s = 0.25;  ///< s. After a longer time the prediction says little: key frames, gaps.
  double better = 1.02;       ///< times as many keypoints must fit before another place is believed
  int keypoints = 300;        ///< to search with. The time of a search is in proportion.
};

/// Where a robot may be that was restarted. The standard deviations are those of a robot that
/// stands, or nearly. Found with test_robot: corridor, lobby, office and car park, killed while
/// driving.
struct RestartConfig {
  double position_m = 0.15;  ///< m, standard deviation. A wider one finds places that look alike, 2.5 m apart.
  double angle_rad = 0.15;   ///< rad, standard deviation
  double speed_m_s = 0.2;    ///< m/s, standard deviation about rest
  double turn_rad_s = 0.2;   ///< rad/s, standard deviation about rest
  /// s. Times the last twist, it adds to the standard deviations of position and angle: a third of
  /// the longest way to rest. Motors stop 1/3 s after the last saved pose by their own watchdog,
  /// then brake.
  double braking_s = 0.17;
  /// s. The robot has come to rest by then, so a longer absence moves it no farther.
  double coasting_s = 1.0;
  /// Share, of the keypoints that the previous run's last scan has on known surfaces, that the
  /// first scan must reach. Restarts reached 0.89 and more. Robots carried away by 4 to 14 m
  /// reached 0.76 at most, but 0.88 once, along an office corridor that looks alike everywhere.
  double found_share = 0.82;
};

/// Settings of LidarOdometry. The defaults suit wheeled robots and slow drones with a spinning
/// 16…64-beam LiDAR. `odometry_accuracy all 60 1 KEY=VALUE` (tests/bench) shows what another value
/// does.
struct OdometryConfig {
  // Points
  double min_range_m = 0.5;    ///< m. Nearer points are not used. Chosen by hand.
  double max_range_m = 100.0;  ///< m. Farther points are not used. Range of a VLP-16 (data sheet).
  /// m, edge of the cubes in which a scan adds one point to the map. Halved from 0.1 m together
  /// with correlation_factor, for the same scenes.
  double insert_spacing_m = 0.05;
  int keypoints = 2500;  ///< points to register; their spacing follows. The time of a scan is in proportion.

  // Registration
  int max_iterations = 12;  ///< steps per scan; the budget may grant fewer
  /// m. The last steps match a point with patches this near: 6 standard deviations of a VLP-16's
  /// 0.03 m (data sheet).
  double narrowest_gate_m = 0.2;
  /// m. The first step reaches no farther, however uncertain the prediction is: the edge of the
  /// coarsest blocks.
  double widest_gate_m = 2.0;

  // Map of the recent past
  double finest_block_m = 0.5;     ///< m, edge of the smallest blocks; the others have 2 and 4 times this
  double window_m = 80.0;          ///< m, radius around the robot in which the map is kept
  int max_blocks = 1 << 16;        ///< in each of the two finest grids, half as many in each coarser one: 50 MB in all
  int max_points_per_block = 400;  ///< a block that has seen so many does not change any more

  /// s. A surface that has been seen for less time is fresh. It was made with the twist that is now estimated, so it
  /// confirms that twist, be it wrong. 0.5 s does nearly as well.
  double lasting_s = 1.0;
  /// Share of its weight that a point on a fresh wall or pole counts. In a simulated office with a queue of people
  /// behind the robot, the lateral speed was wrong by 1.3 m/s with 1, and the pose jumped by 0.3 m. 0.03 does as well
  /// as 0.1.
  double fresh_share = 0.1;

  // Weights
  double noise_floor_m = 0.01;    ///< m, least standard deviation of a point-to-patch distance. Chosen by hand.
  double max_thickness_m = 0.06;  ///< m, standard deviation across a plane: twice a VLP-16's 0.03 m (data sheet)
  /// Points per independent piece of information, because neighbouring points err alike. Doubled
  /// from 20, which lets the prediction outvote few residuals: `odometry_accuracy forest` and
  /// `odometry_accuracy office` hold since.
  double correlation_factor = 40.0;

  // Motion: standard deviations of a white acceleration, and of the speed before the second scan
  /// m/s². With 3, a wrong twist and a map made with it confirmed each other: the lateral speed of
  /// a robot in a simulated office grew to 1.2 m/s within 10 s. With 1, none of 21 robots is lost,
  /// and offices are a third straighter.
  double linear_acceleration = 1.0;
  double angular_acceleration = 1.0;  ///< rad/s². As the linear one, found in the same runs.
  /// Scans until a map's first one, taken in an unknown motion, is outweighed. Until then both
  /// accelerations count settling_noise_factor times: 3 m/s², as before they were lowered.
  int settling_scans = 20;
  double settling_noise_factor = 3.0;
  double initial_speed = 10.0;  ///< m/s. With 3, a start at 8 m/s was taken for rest (`odometry_accuracy kitti`).
  double initial_angular_speed = 1.0;  ///< rad/s
  double max_speed = 50.0;             ///< m/s. A faster motion is not believed. Chosen by hand.
  double max_angular_speed = 6.0;      ///< rad/s. A faster turn is not believed. About one turn a second.

  // When a scan is lost
  double min_inlier_ratio = 0.4;  ///< at least this share of the points near patches must lie on them
  /// At least so many points must lie near patches: ten for each of the six directions. Where the
  /// surroundings determine fewer directions, fewer are enough.
  int min_matches = 60;
  double min_facing_points = 10.0;  ///< a direction is degenerate if fewer points look at a surface that faces it
  /// Lost scans in a row until a new map begins, where wheels tell how it lies to the one before, or where there was
  /// hardly one: one second at 10 Hz.
  int reinitialise_after = 10;
  /// The same where nothing tells it: 5 s at 10 Hz, in which the robot may be found again.
  int give_up_after = 50;

  StartSearchConfig start_search;
  AgilityConfig agility;
  SecondLookConfig second_look;
  RestartConfig restart;
};

/// Names, units and bounds of every key (config section `odometry`).
void declare(config::Section& section, OdometryConfig& c);
void declare(config::Section& section, StartSearchConfig& c);
void declare(config::Section& section, AgilityConfig& c);
void declare(config::Section& section, SecondLookConfig& c);
void declare(config::Section& section, RestartConfig& c);

}  // namespace cairn::odometry
