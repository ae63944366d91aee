// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// Whether the folder is what a run left: it holds a report.json.
[[nodiscard]] bool is_run(const std::filesystem::path& folder);

/// The folder of a run: what its report says of it, its trajectory, its map and its files. What cannot be read is told
/// in `damage`.
[[nodiscard]] report::Json inspect_run(const std::filesystem::path& folder);

/// A folder that is neither a recording nor a run: the recordings and runs in it. Error kUnsupported where there are
/// none; the detail says what else is there.
[[nodiscard]] Result<report::Json> inspect_parent(const std::filesystem::path& folder);

}  // namespace cairn::cli
