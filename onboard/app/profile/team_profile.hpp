// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "fusion/team/team.hpp"
#include "hal/config/config.hpp"

namespace cairn::app {

/// Where a robot is put down: its odom frame in a metric frame, x and y level, z up, that all robots of a team share.
struct DeploymentProfile {
  double x_m = 0, y_m = 0, z_m = 0;
  double yaw_deg = 0;      ///< of the robot's x axis from the site's, anticlockwise
  double sigma_m = 0;      ///< of each coordinate; 0: nothing is known
  double sigma_deg = 180;  ///< of the heading

  /// None where nothing is known. Upright: leans by as much as the heading is uncertain, and not more than floors do.
  [[nodiscard]] std::optional<UncertainPose> T_site_odom() const;
};

void declare(config::Section& section, DeploymentProfile& profile);

/// The satellite receiver at the LiDAR tells where the robot is, in a frame with this origin: x east, y north.
struct SatelliteProfile {
  double origin_latitude_deg = 0, origin_longitude_deg = 0;  ///< WGS 84, the same on all robots; both 0: not used
  double sigma_m = 3;                                        ///< of the receiver, each coordinate

  [[nodiscard]] bool on() const { return origin_latitude_deg != 0 || origin_longitude_deg != 0; }
};

void declare(config::Section& section, SatelliteProfile& profile);

/// A robot's place in its team; `cairn run --peers` takes part.
struct TeamProfile {
  int id = 0;                                    ///< its own in the team; 0: it has none
  std::string socket = "/run/cairn/peers.sock";  ///< local, shared with cairn-peers
  int bytes_per_second = 16000;                  ///< that the core hands out, all overhead included
  double match_s = 5;                            ///< one comparison of two maps may take so long
  double submap_m = 300;                         ///< of the path through one submap
  double drift_percent = 1;                      ///< of the path, that odometry may be off at its end, per axis,
  double drift_deg_per_m = 0.02;                 ///< and turned
  double body_radius_m = 0.6;                    ///< of the upright cylinder around the robot
  double body_height_m = 0.9;                    ///< of its top, above base_link
  DeploymentProfile deployment;
  SatelliteProfile satellites;
};

void declare(config::Section& section, TeamProfile& profile);
/// What a range for each value cannot say; kInvalidConfig, all faults in `detail`.
[[nodiscard]] Result<void> check(const TeamProfile& profile);

/// What the library wants to know. `name`: of the robot.
[[nodiscard]] team::TeamConfig team_config(const TeamProfile& profile, peers::RobotId id, const std::string& name,
                                           double resolution_m);

inline constexpr unsigned kRandomBits = 30;
/// A number that no earlier beginning of this robot had: the time of day in seconds, and random bits for a clock that
/// was set back.
[[nodiscard]] peers::Epoch new_epoch(Time now_utc);
/// The next beginning of the same run.
[[nodiscard]] constexpr peers::Epoch after(peers::Epoch epoch) { return epoch + (peers::Epoch{1} << kRandomBits); }

}  // namespace cairn::app
