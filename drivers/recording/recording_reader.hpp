// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/merged_source.hpp"
#include "hal/ports.hpp"

namespace cairn::recording {

/// Source `index` of a recording in `dir`, its packets on the robot's time line. Errors: those of its file.
[[nodiscard]] Result<std::unique_ptr<Source>> open_recorded_source(const std::filesystem::path& dir,
                                                                   const Recording& recording, std::size_t index);

/// Replays a recording folder: the packets of all its sources as they arrived, on the robot's monotonic time line, in
/// the order of (arrival, source, sequence). Never waits; PacedSource waits.
class RecordingReader final : public Source {
 public:
  /// Error when recording.yaml cannot be used. If the file of a source cannot be opened, next() says so first, and the
  /// other sources go on.
  [[nodiscard]] static Result<std::unique_ptr<RecordingReader>> open(const std::filesystem::path& dir);

  /// An Error names file and offset of the damage in one source; go on calling. The packets before the damage are
  /// handed out. kTimeout: no wanted packet among the last records of a capture; go on calling.
  Result<Poll> next(Packet& packet, Duration timeout) override { return packets_.next(packet, timeout); }

  [[nodiscard]] const Recording& recording() const { return recording_; }

 private:
  RecordingReader(Recording recording, std::vector<std::unique_ptr<Source>> sources)
      : recording_(std::move(recording)), packets_(std::move(sources)) {}

  Recording recording_;
  MergedSource packets_;
};

}  // namespace cairn::recording
