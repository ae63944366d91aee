// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/config.hpp"

namespace cairn::gpio {

void declare(config::Section& s, Config& c) {
  s.text("chip", c.chip,
         "name, path, number or label of the GPIO chip; gpiodetect shows which there are; or file:FOLDER, whose files "
         "are the lines");
  s.text("estop_line", c.estop_line, "input of the e-stop's normally-closed contact; empty: none");
  s.flag("estop_active_low", c.estop_active_low, "the closed contact ties the line to ground");
  s.choice("estop_bias", c.estop_bias, {"as-is", "disabled", "pull-up", "pull-down"},
           "must pull an open line to the level that means open, so that a broken wire stops");
  s.number("estop_release_ms", c.estop_release_ms, {0, 1000}, "ms",
           "the contact must stay closed so long to count as released");
  s.number("estop_rearm_ms", c.estop_rearm_ms, {0, 10000}, "ms", "and so long before arming is allowed");
  s.text("trigger_line", c.trigger_line,
         "output for the trigger of cameras that are `triggered`; cairn run pulses it; empty: none");
  s.number("trigger_rate_hz", c.trigger_rate_hz, {0.1, 1000}, "Hz", "pulses per second");
  s.number("trigger_pulse_ms", c.trigger_pulse_ms, {0.05, 1000}, "ms", "length of a pulse, to 2 ms");
  s.text("pps_line", c.pps_line,
         "input of the pulse per second that the LiDAR gets, too: sets its stamps with lidar.time_source pps; empty: "
         "none");
}

Result<void> check(const Config& c) {
  std::string faults;
  const auto fault = [&](const char* text) { faults += (faults.empty() ? "" : "\n") + std::string(text); };
  const auto same = [](const std::string& a, const std::string& b) { return !a.empty() && a == b; };
  if (same(c.estop_line, c.trigger_line) || same(c.estop_line, c.pps_line) || same(c.trigger_line, c.pps_line))
    fault("estop_line, trigger_line and pps_line must differ");
  if (c.trigger_pulse_ms * c.trigger_rate_hz >= 1000) fault("trigger_pulse_ms must be shorter than the period");
  if (c.estop_rearm_ms < c.estop_release_ms) fault("estop_rearm_ms must not be below estop_release_ms");
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the configuration of the GPIO lines", {}, {}, faults};
}

}  // namespace cairn::gpio
