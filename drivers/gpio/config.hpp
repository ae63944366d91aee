// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"

namespace cairn::gpio {

/// The lines of one GPIO chip that the robot uses. A line is named, or given by its number on the chip; empty: none.
struct Config {
  std::string chip = "gpiochip0";  ///< name, path, number or label
  std::string estop_line;
  bool estop_active_low = false;     ///< the closed contact reads low: it ties the line to ground
  std::string estop_bias = "as-is";  ///< such that an open contact reads as open
  double estop_release_ms = 5;
  double estop_rearm_ms = 500;
  std::string trigger_line;
  double trigger_rate_hz = 10;
  double trigger_pulse_ms = 1;
  std::string pps_line;
};

void declare(config::Section& section, Config& config);
/// Faults between keys, all in one Error.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::gpio
