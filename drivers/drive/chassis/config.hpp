// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"

namespace cairn::drive {

/// A drive on a CAN bus: how it is reached, its geometry and scales, and its limits. Section `drive` of the profile.
struct Config {
  std::string protocol = "cia402";  ///< cia402 or agilex
  std::string interface = "can0";   ///< SocketCAN interface, configured and up; or unix:PATH (UnixCanLink)

  double wheel_separation_m = 0;  ///< effective distance of left and right wheels; larger than real for skid steering
  double wheel_radius_m = 0;      ///< 0: not known, and a CiA 402 drive cannot be enabled
  double max_speed_m_s = 1;       ///< faster commands are slowed down; the path keeps its curvature
  double max_yaw_rate_rad_s = 1;  ///< likewise

  // CiA 402: numbers of nodes and objects are those of CANopen
  int host_node = 127;                                ///< of this computer
  int left_node = 1, right_node = 2;                  ///< of the wheels
  int rear_left_node = 0, rear_right_node = 0;        ///< 0: none
  bool left_reversed = false, right_reversed = true;  ///< the motors count backwards when the robot drives ahead
  double velocity_units_per_rad_s = 0;                ///< 60FF and 606C for 1 rad/s of the wheel
  double position_counts_per_rad = 0;                 ///< 6064 for 1 rad of the wheel
  double acceleration_m_s2 = 1, quick_stop_m_s2 = 3;  ///< ramps: 6083 and 6084; 6085
  int heartbeat_ms = 100;                             ///< of the nodes
  int host_heartbeat_ms = 100;  ///< after which a node without the host's heartbeat stops by itself
  int vendor = 0, product = 0;  ///< 1018; 0: any

  // AgileX
  bool ackermann = false;     ///< Hunter: steers its front wheels
  double wheelbase_m = 0.65;  ///< of an Ackermann robot

  // wheel odometry, all 1 σ
  double travel_noise_m = 0.02;    ///< of one side after 1 m; grows with the square root of the way
  double travel_scale = 0.01;      ///< unknown error of the wheel radius, as a share
  double rotation_scale = 0.05;    ///< unknown error of the effective separation, as a share
  double lateral_slip = 0.05;      ///< sideways motion in a turn, as a share of what the wheels' rims go apart
  double ground_noise_m = 0.01;    ///< height after 1 m
  double ground_noise_rad = 0.01;  ///< roll and pitch after 1 m
  double traction_m_s2 = 4;        ///< a wheel that changes its speed faster is slipping
  double slip_factor = 0.5;        ///< share of a slipping wheel's travel that is doubted
};

/// Keys, units and bounds of a Config.
void declare(config::Section& section, Config& config);
/// Checks relations between keys. Error kInvalidConfig with all faults. enable_fault() checks what only enabling needs.
[[nodiscard]] Result<void> check(const Config& config);
/// The keys that are missing before a motor may be enabled: geometry and scales. Empty when none is missing.
[[nodiscard]] std::string enable_fault(const Config& config);

}  // namespace cairn::drive
