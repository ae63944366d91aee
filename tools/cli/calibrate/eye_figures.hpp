// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "onboard/perception/calibration/camera_calibration.hpp"
#include "onboard/perception/cameras/calibration_file.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// A number that is null in JSON where it is not finite.
[[nodiscard]] report::Json number(double value);
/// The numbers of one eye with their standard deviations.
[[nodiscard]] report::Json eye_json(const calibration::EyeEstimate& eye);
/// The same as lines of text.
[[nodiscard]] std::string eye_text(const calibration::EyeEstimate& eye);
/// What the views show.
[[nodiscard]] report::Json coverage_json(const calibration::Coverage& coverage);

/// Says on stdout why a calibration is refused, and what to record. Empty faults: what would make it better.
void print_verdict(const std::vector<std::string>& faults, const std::vector<std::string>& missing);

/// Writes the cameras as `format`: kalibr, ros or opencv. The last two hold the first camera alone.
[[nodiscard]] Result<void> write_calibration(const std::filesystem::path& out, const std::string& format,
                                             const cameras::Calibration& calibration);

}  // namespace cairn::cli
