// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/camera/config.hpp"

namespace cairn::depth {

/// One depth camera: how it is reached, and its intrinsics. Section `depth` of the profile. The device rectifies the
/// picture, as RGB-D cameras do: a pinhole without distortion.
struct Config {
  camera::CaptureConfig capture{
      .device = "", .format = "Z16", .width = 640, .height = 480, .rate_hz = 30, .buffers = 4};
  double fx = 385, fy = 385;  ///< focal lengths, pixels; about those of a RealSense D435 at 640×480: use your own
  double cx = 320, cy = 240;  ///< principal point, pixels from the centre of the left column and top row
  double unit_m = 0.001;      ///< metres of one count
  double min_depth_m = 0.2;   ///< along the optical axis; nearer points are dropped
  double max_depth_m = 6;     ///< along the optical axis; farther points are dropped
  int step_px = 2;            ///< one pixel is taken of so many columns and rows
  double latency_ms = 0;      ///< from the exposure to the stamp of the frame; it is subtracted
};

/// Keys, units and bounds.
void declare(config::Section& section, Config& config);
/// Checks what bounds cannot. Error kInvalidConfig with all faults.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::depth
