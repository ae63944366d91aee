// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

/// Writes report.json and report.html into an existing folder, each atomically.
Result<void> write_report(const RunReport& report, const std::filesystem::path& folder);

}  // namespace cairn::report
