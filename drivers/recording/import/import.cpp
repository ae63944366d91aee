// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/import/import.hpp"

#include <string>

namespace cairn::recording {

const std::vector<std::string>& import_kinds() {
  static const std::vector<std::string> kinds{"velodyne-pcap", "kitti-odometry", "kitti-raw", "pcd-folder"};
  return kinds;
}

namespace {

Result<ImportReport> import_into(std::string_view kind, const ImportOptions& options) {
  if (kind == "velodyne-pcap") return import_velodyne_pcap(options);
  if (kind == "kitti-odometry") return import_kitti_odometry(options);
  if (kind == "kitti-raw") return import_kitti_raw(options);
  if (kind == "pcd-folder") return import_pcd_folder(options);
  return Error{Errc::kInvalidConfig, "unknown kind of data to import", std::string(kind), {}, {}};
}

}  // namespace

Error import_interrupted(const ImportOptions& options) {
  return {Errc::kTruncated, "interrupted before the end", options.source.string(), {}, "nothing was imported"};
}

Result<ImportReport> import(std::string_view kind, const ImportOptions& options) {
  if (lies_in(options.source, options.out))
    return Error{Errc::kInvalidConfig, "the output folder must not hold the source", options.out.string(), {}, {}};
  if (!(options.rate_hz > 0 && options.rate_hz <= 1000))
    return Error{Errc::kInvalidConfig, "the rate must lie in 0 … 1000 Hz", "rate", {}, std::to_string(options.rate_hz)};
  auto recording = NewRecording::begin(options.out, options.overwrite);
  if (!recording) return recording.error();
  ImportOptions inside = options;
  inside.out = recording->folder();
  auto report = import_into(kind, inside);
  if (!report) return recording->nothing_kept(report.error());
  if (auto finished = recording->finish(); !finished) return finished.error();
  return report;
}

}  // namespace cairn::recording
