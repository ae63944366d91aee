// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"

namespace cairn::drive {

/// A drive on a CAN bus: how it is reached, what moves when it turns, and what it may do.
struct Config {
  std::string protocol = "cia402";
  std::string interface = "can0";

  double wheel_separation_m = 0;  ///< effective: for skid steering wider than the wheels stand
  double wheel_radius_m = 0;
  double max_speed_m_s = 1;
  double max_yaw_rate_rad_s = 1;

  // CiA 402
  int host_node = 127;
  int left_node = 1, right_node = 2;
  int rear_left_node = 0, rear_right_node = 0;  ///< 0: none
  bool left_reversed = false, right_reversed = true;
  double velocity_units_per_rad_s = 0;  ///< 60FF and 606C for 1 rad/s of the wheel
  double position_counts_per_rad = 0;   ///< 6064 for 1 rad of the wheel
  double acceleration_m_s2 = 1, quick_stop_m_s2 = 3;
  int heartbeat_ms = 100;       ///< of the nodes
  int host_heartbeat_ms = 100;  ///< after which a node without the host's heartbeat stops by itself
  int vendor = 0, product = 0;  ///< 1018; 0: any

  // AgileX
  bool ackermann = false;  ///< Hunter: steers its front wheels
  double wheelbase_m = 0.65;

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

void declare(config::Section& section, Config& config);
/// Faults between keys, all in one Error. What only enabling needs is left to enable_fault().
[[nodiscard]] Result<void> check(const Config& config);
/// What must be configured before a motor may be enabled: geometry and scales. An empty text when all is there.
[[nodiscard]] std::string enable_fault(const Config& config);

}  // namespace cairn::drive
