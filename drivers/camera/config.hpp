// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/config/config.hpp"

namespace cairn::camera {

/// What a V4L2 device is asked for. Part of the configuration of all cameras.
struct CaptureConfig {
  std::string device;           ///< path, best below /dev/v4l/by-id; empty: the camera does not exist
  std::string format = "YUYV";  ///< name of a FrameFormat
  int width = 1344;             ///< pixels of the whole frame: both eyes, telemetry rows and all
  int height = 376;             ///< pixels of the whole frame
  double rate_hz = 15;          ///< frames per second; the device may grant another rate
  int buffers = 4;              ///< frames that the kernel may fill before one is taken
  bool triggered = false;       ///< the trigger line exposes it: the pulse before a frame is the time of its exposure
};

/// A colour camera: alone, or two side by side in one picture (ZED: 2 × 672×376). Section `camera` of the profile.
struct Config {
  CaptureConfig capture;
  bool side_by_side = true;  ///< the left half of the frame is the left eye
  double latency_ms = 0;     ///< from the exposure to the stamp of the frame; it is subtracted
};

/// Keys, units and bounds.
void declare(config::Section& section, CaptureConfig& config);
/// Keys, units and bounds.
void declare(config::Section& section, Config& config);
/// Checks what bounds cannot. Error kInvalidConfig with all faults.
[[nodiscard]] Result<void> check(const CaptureConfig& config);
/// Checks what bounds cannot. Error kInvalidConfig with all faults.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::camera
