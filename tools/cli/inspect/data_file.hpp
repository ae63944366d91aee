// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// Whether the file begins as a PNG, JPEG or TIFF does.
[[nodiscard]] bool is_picture(const std::filesystem::path& path);
/// Kind, size and format of a picture; of grey ones also the range of the values. A picture that cannot be decoded is
/// told in `damage`. Errors: its header cannot be read.
[[nodiscard]] Result<report::Json> inspect_picture(const std::filesystem::path& path);

/// A sweep as KITTI keeps it: records of float32 x y z intensity, or of these and u32 offset_ns.
struct Sweep {
  report::Json json;
  PointCloud cloud;  ///< without the points that were rejected
};
/// Errors: of reading; kUnsupported where the bytes are no such records.
[[nodiscard]] Result<Sweep> inspect_sweep(const std::filesystem::path& path);

/// A .npy file that holds no pictures: type and shape. Errors: it is no .npy file.
[[nodiscard]] Result<report::Json> inspect_numbers(const std::filesystem::path& path);

}  // namespace cairn::cli
