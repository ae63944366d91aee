// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "hal/config/config.hpp"
#include "onboard/safety/fault.hpp"

namespace cairn::safety {

/// Section `failsafe` of a robot profile: after how long a sensor counts as missing, and the mode of each fault. A
/// profile may make both stricter than the defaults, never milder: the bounds are part of the declaration.
struct FailsafeConfig {
  FailsafeConfig();

  double lidar_late_ms = 150;      ///< a scan and a half at 10 Hz
  double lidar_silent_ms = 500;    ///< five scans
  int lidar_recover_scans = 2;     ///< good scans in a row that end lidar_late and lidar_silent
  double camera_silent_ms = 200;   ///< three frames at 15 Hz
  double thermal_silent_ms = 334;  ///< three frames at 9 Hz
  double depth_silent_ms = 200;
  double feedback_late_ms = 100;  ///< as drive::Guard, which decides by itself as well
  double feedback_lost_ms = 250;
  double degraded_speed_m_s = 0.5;  ///< cap in Mode::kDegraded

  std::array<std::string, kFaults> action;  ///< by Fault: normal, degraded, hold or stop

  /// The mode of a fault. An action that is no mode, or milder than the safe one, counts as the safe one.
  [[nodiscard]] Mode mode(Fault fault) const;
};

void declare(config::Section& section, FailsafeConfig& config);
/// Checks keys against each other. Error kInvalidConfig, with all faults.
[[nodiscard]] Result<void> check(const FailsafeConfig& config);

}  // namespace cairn::safety
