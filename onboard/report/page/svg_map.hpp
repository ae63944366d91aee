// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/result.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::report::html {

/// The map from above with the trajectory and the ground truth drawn over it, as one inline SVG.
Result<std::string> svg_map(const RunReport& report);

}  // namespace cairn::report::html
