// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/camera/config.hpp"

namespace cairn::depth {

/// One depth camera: how it is reached and how its pixels look into the world. The picture is rectified by the device
/// (RGB-D cameras do so): a pinhole without distortion.
struct Config {
  camera::CaptureConfig capture{
      .device = "", .format = "Z16", .width = 640, .height = 480, .rate_hz = 30, .buffers = 4};
  double fx = 385, fy = 385;  ///< of a RealSense D435 at 640×480, about: use your own
  double cx = 320, cy = 240;
  double unit_m = 0.001;
  double min_depth_m = 0.2;
  double max_depth_m = 6;
  int step_px = 2;
  double latency_ms = 0;
};

/// Keys, units and bounds.
void declare(config::Section& section, Config& config);
/// What bounds alone cannot say, all faults in one Error.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::depth
