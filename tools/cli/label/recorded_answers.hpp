// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// The pictures in RECORDING/labels: how many, their sizes, the share of each class in all pixels. Null where there is
/// no such folder. Faults are appended to `damage`, one text for each picture.
[[nodiscard]] report::Json describe_labels(const std::filesystem::path& recording, std::vector<std::string>& damage);

/// RECORDING/boxes.csv: pictures of each camera, boxes of each class. Null where there is no such file.
[[nodiscard]] report::Json describe_boxes(const std::filesystem::path& recording, std::vector<std::string>& damage);

}  // namespace cairn::cli
