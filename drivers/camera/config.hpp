// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"

namespace cairn::camera {

/// What a V4L2 device is asked for. Cameras of all kinds have one.
struct CaptureConfig {
  std::string device;  ///< empty: the sensor is replayed only
  std::string format = "YUYV";
  int width = 1344;
  int height = 376;
  double rate_hz = 15;
  int buffers = 4;
};

/// A colour camera: alone, or two side by side in one picture (ZED: 2 × 672×376).
struct Config {
  CaptureConfig capture;
  bool side_by_side = true;
  double latency_ms = 0;
};

/// Keys, units and bounds.
void declare(config::Section& section, CaptureConfig& config);
void declare(config::Section& section, Config& config);
/// What bounds alone cannot say, all faults in one Error.
[[nodiscard]] Result<void> check(const CaptureConfig& config);
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::camera
