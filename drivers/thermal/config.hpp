// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "drivers/camera/config.hpp"

namespace cairn::thermal {

/// One thermal camera: how it is reached and what its counts mean. Section `thermal` of the profile.
struct Config {
  camera::CaptureConfig capture{.device = "", .format = "Y16", .width = 160, .height = 122, .rate_hz = 9, .buffers = 4};
  std::string model = "lepton3";  ///< name of a Model
  std::string units = "auto";     ///< of a count: auto (as telemetry says), counts, centikelvin, decikelvin or optris
  /// Percentiles of the pixels that become black and white in the 8-bit picture.
  std::vector<double> stretch_percent{0.5, 99.5};
  double min_span_c = 5;         ///< °C; the 8-bit picture spans at least so much
  double min_span_counts = 100;  ///< the same for frames in counts
  double latency_ms = 0;         ///< from the exposure to the stamp of the frame; it is subtracted
};

/// Keys, units and bounds.
void declare(config::Section& section, Config& config);
/// Checks what bounds cannot. Error kInvalidConfig with all faults.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::thermal
