// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "hal/result.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// What a calibration file of cameras says: format, sizes, focal lengths, and how wide each camera sees. With `out`,
/// the calibration is also written there as `format`: kalibr, ros or opencv. `camera`: which one, for formats of one
/// camera. Errors: those of the file; kInvalidConfig where the format is missing; kNotFound, kUnsupported.
[[nodiscard]] Result<report::Json> inspect_calibration(const std::filesystem::path& path,
                                                       const std::filesystem::path& out, const std::string& format,
                                                       std::size_t camera);

}  // namespace cairn::cli
