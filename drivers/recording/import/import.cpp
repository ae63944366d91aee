// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/import/import.hpp"

#include <algorithm>
#include <string>
#include <system_error>

namespace cairn::recording {

const std::vector<std::string>& import_kinds() {
  static const std::vector<std::string> kinds{"velodyne-pcap", "kitti-odometry", "kitti-raw", "pcd-folder"};
  return kinds;
}

namespace {

namespace fs = std::filesystem;

/// Overwriting a recording with what is imported from it would delete the source before it is read.
bool source_is_inside_out(const ImportOptions& options) {
  std::error_code error;
  const fs::path out = fs::weakly_canonical(options.out, error), source = fs::weakly_canonical(options.source, error);
  return std::mismatch(out.begin(), out.end(), source.begin(), source.end()).first == out.end();
}

}  // namespace

Result<ImportReport> import(std::string_view kind, const ImportOptions& options) {
  if (source_is_inside_out(options))
    return Error{Errc::kInvalidConfig, "the output folder must not hold the source", options.out.string(), {}, {}};
  if (!(options.rate_hz > 0 && options.rate_hz <= 1000))
    return Error{Errc::kInvalidConfig, "the rate must lie in 0 … 1000 Hz", "rate", {}, std::to_string(options.rate_hz)};
  if (kind == "velodyne-pcap") return import_velodyne_pcap(options);
  if (kind == "kitti-odometry") return import_kitti_odometry(options);
  if (kind == "kitti-raw") return import_kitti_raw(options);
  if (kind == "pcd-folder") return import_pcd_folder(options);
  return Error{Errc::kInvalidConfig, "unknown kind of data to import", std::string(kind), {}, {}};
}

}  // namespace cairn::recording
