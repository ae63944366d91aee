// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/report/json/budgets.hpp"

namespace cairn::app {

/// The stages that runs time.
[[nodiscard]] std::span<const std::string_view> known_stages();

/// Whether the report of this run can have the fields of the budgets, as far as that is known before the run: keys of
/// report.json, tasks, stages, and the sensors of the profile or the recording. A profile or a recording that cannot be
/// read is no fault here. Error kInvalidConfig: all misspelt fields at once, with file and line.
[[nodiscard]] Result<void> check_budget_fields(const std::vector<report::BudgetLimit>& limits,
                                               const RunOptions& options);

}  // namespace cairn::app
