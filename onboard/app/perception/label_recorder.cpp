// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/label_recorder.hpp"

#include <memory>
#include <utility>

namespace cairn::app {

Result<std::unique_ptr<LabelRecorder>> LabelRecorder::create(const std::filesystem::path& recording, Monitor& monitor) {
  auto writer = networks::LabelFolderWriter::create(recording / networks::kLabelFolder);
  if (!writer) return writer.error();
  return std::unique_ptr<LabelRecorder>(new LabelRecorder(std::move(*writer), monitor));
}

void LabelRecorder::keep(const LabelImage& labels) {
  LabelImage* place = waiting_.back();
  if (place == nullptr) {
    ++lost_;
    return;
  }
  *place = labels;
  waiting_.push();
}

void LabelRecorder::write_waiting(Time now) {
  for (; const LabelImage* labels = waiting_.front(); waiting_.pop()) {
    if (failed_) continue;
    const auto written = writer_.write(*labels);
    failed_ = !written;
    if (failed_) monitor_.event(now, "recording", "labels are no longer kept: " + to_string(written.error()));
  }
  if (const std::uint64_t lost = lost_; lost != std::exchange(reported_, lost))
    monitor_.event(now, "recording", "labels were lost to the recording: the disk was too slow");
}

}  // namespace cairn::app
