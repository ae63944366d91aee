// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "drivers/recording/import/import.hpp"
#include "hal/point_cloud.hpp"

namespace cairn::recording {

/// Writes sweeps one after the other into a recording with one source of kind `scans`, and where there are pictures,
/// one of kind `camera`. All importers of sweeps use it.
class SweepImport {
 public:
  /// What the recording is to say of itself.
  struct Description {
    bool deskewed = false;  ///< the sweeps are motion-compensated
    std::string notes{};
    std::int64_t start_utc_ns = 0;  ///< nanoseconds since 1970; 0: not known
    std::string camera{};           ///< model of the camera; empty: there are no pictures
  };
  /// Makes the recording. `options` must outlive the result. Errors: those of RecordingWriter::create().
  [[nodiscard]] static Result<SweepImport> create(const ImportOptions& options, const Description& description);

  /// Appends a sweep that ended at `end`. Ends must increase.
  [[nodiscard]] Result<void> add(Time end, const PointCloud& cloud, bool with_offset);
  /// Appends a picture file of the camera. Stamps must increase. Error: the picture cannot be read or recorded.
  [[nodiscard]] Result<void> add_picture(Time stamp, std::span<const std::byte> file);
  /// Notes a part that could not be read. The import goes on.
  void damaged(Error error);
  [[nodiscard]] ImportReport& report() { return report_; }
  /// Closes the recording. Error when not one sweep was good.
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
