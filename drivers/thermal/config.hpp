// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "drivers/camera/config.hpp"

namespace cairn::thermal {

/// One thermal camera: how it is reached and what its counts mean.
struct Config {
  camera::CaptureConfig capture{.device = "", .format = "Y16", .width = 160, .height = 122, .rate_hz = 9, .buffers = 4};
  std::string model = "lepton3";
  std::string units = "auto";
  std::vector<double> stretch_percent{0.5, 99.5};
  double min_span_c = 5;
  double min_span_counts = 100;
  double latency_ms = 0;
};

/// Keys, units and bounds.
void declare(config::Section& section, Config& config);
/// What bounds alone cannot say, all faults in one Error.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace cairn::thermal
