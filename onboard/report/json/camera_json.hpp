// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

/// What became of the pictures, as report.json has it under `labels`, `depth`, `visual_odometry` and `people`; null
/// where the run looked at none.
[[nodiscard]] nlohmann::json labels_json(const RunReport& report);
[[nodiscard]] nlohmann::json visual_odometry_json(const RunReport& report);
[[nodiscard]] nlohmann::json depth_json(const RunReport& report);
[[nodiscard]] nlohmann::json people_json(const RunReport& report);
/// A list, empty where no mount was watched.
[[nodiscard]] nlohmann::json mounts_json(const RunReport& report);

}  // namespace cairn::report
