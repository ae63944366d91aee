// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/recording/import/import.hpp"
#include "hal/point_cloud.hpp"

namespace cairn::recording {

/// What the importers of sweeps have in common: a recording with one source of kind `scans`, sweep after sweep.
class SweepImport {
 public:
  [[nodiscard]] static Result<SweepImport> create(const ImportOptions& options, bool deskewed, std::string notes,
                                                  std::int64_t start_utc_ns = 0);

  /// Appends a sweep that ended at `end`. Ends must increase.
  [[nodiscard]] Result<void> add(Time end, const PointCloud& cloud, bool with_offset);
  /// Notes what could not be read; the import goes on.
  void damaged(Error error);
  [[nodiscard]] ImportReport& report() { return report_; }
  /// Closes the recording. Error when not a single sweep came through.
  [[nodiscard]] Result<ImportReport> finish();

 private:
  SweepImport(RecordingWriter writer, const ImportOptions& options) : writer_(std::move(writer)), options_(options) {}

  RecordingWriter writer_;
  const ImportOptions& options_;
  ImportReport report_;
};

/// One sweep of KITTI: float32 x y z reflectance (0…1), points that are not finite left out and counted.
[[nodiscard]] Result<PointCloud> read_kitti_sweep(const std::filesystem::path& path, std::uint64_t& rejected);

}  // namespace cairn::recording
