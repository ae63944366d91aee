// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

/// A run in some lines for a terminal: what it did, what it cost, what happened, and the notes.
[[nodiscard]] std::string to_summary(const RunReport& report);

}  // namespace cairn::report
