// SPDX-License-Identifier: Apache-2.0
#include "drivers/depth/config.hpp"

#include <string>

namespace cairn::depth {

void declare(config::Section& s, Config& c) {
  s.group("capture", c.capture, "what the device is asked for");
  s.number("fx", c.fx, {1, 1e5}, "px", "focal length, horizontally");
  s.number("fy", c.fy, {1, 1e5}, "px", "focal length, vertically");
  s.number("cx", c.cx, {-1e5, 1e5}, "px", "principal point, from the centre of the left column");
  s.number("cy", c.cy, {-1e5, 1e5}, "px", "principal point, from the centre of the top row");
  s.number("unit_m", c.unit_m, {1e-6, 0.1}, "m", "of one count (RealSense: 0.001, D405 0.0001)");
  s.number("min_depth_m", c.min_depth_m, {0, 100}, "m", "nearer points are dropped; along the optical axis");
  s.number("max_depth_m", c.max_depth_m, {0, 100}, "m", "farther points are dropped; along the optical axis");
  s.integer("step_px", c.step_px, {1, 64}, "px", "every so many columns and rows one pixel is taken");
  s.number("latency_ms", c.latency_ms, {0, 1000}, "ms",
           "from the exposure to the frame's stamp; subtracted by the decoder");
}

Result<void> check(const Config& c) {
  std::string faults;
  const auto fault = [&](const std::string& text) { faults += (faults.empty() ? "" : "\n") + text; };
  if (auto capture = camera::check(c.capture); !capture) fault(capture.error().detail);
  if (c.capture.format != "Z16" && c.capture.format != "Y16") fault("format: depth comes as Z16 or Y16");
  if (!(c.min_depth_m < c.max_depth_m)) fault("min_depth_m has to be below max_depth_m");
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the configuration of a depth camera", {}, {}, faults};
}

}  // namespace cairn::depth
