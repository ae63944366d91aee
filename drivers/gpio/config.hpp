// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"

namespace cairn::gpio {

/// The lines of one GPIO chip that the robot uses. Section `gpio` of the profile. A line is given by its name or by its
/// number on the chip. Empty: there is none.
struct Config {
  std::string chip = "gpiochip0";    ///< name, path, number or label of the chip; or file:FOLDER (FileLines)
  std::string estop_line;            ///< input of the e-stop's normally closed contact
  bool estop_active_low = false;     ///< the closed contact ties the line to ground, so it reads low
  std::string estop_bias = "as-is";  ///< must pull an open line to the level that means open
  double estop_release_ms = 5;       ///< closed for so long: the contact counts as released
  double estop_rearm_ms = 500;       ///< closed for so long: arming is allowed
  std::string trigger_line;          ///< output that triggers the cameras
  double trigger_rate_hz = 10;       ///< pulses per second
  double trigger_pulse_ms = 1;       ///< length of a pulse
  std::string pps_line;              ///< input of a pulse per second
};

/// Keys, units and bounds of a Config.
void declare(config::Section& section, Config& config);
/// Checks relations between keys. Error kInvalidConfig with all faults.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::gpio
