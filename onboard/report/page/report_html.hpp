// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/result.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

/// The content of report.html: one page that needs no network and runs no script. Every text from outside is escaped,
/// and the page's own policy forbids loading anything.
Result<std::string> to_html(const RunReport& report);

}  // namespace cairn::report
