// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// Number of poses, length and times of a TUM file. Poses before a fault count, and the fault is told in `damage`.
[[nodiscard]] report::Json describe_trajectory(const std::filesystem::path& path);

}  // namespace cairn::cli
