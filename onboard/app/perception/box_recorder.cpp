// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/box_recorder.hpp"

#include <algorithm>
#include <utility>

namespace cairn::app {

Result<std::unique_ptr<BoxRecorder>> BoxRecorder::create(const std::filesystem::path& recording, Monitor& monitor) {
  auto writer = networks::BoxWriter::create(recording / networks::kBoxFile);
  if (!writer) return writer.error();
  return std::unique_ptr<BoxRecorder>(new BoxRecorder(std::move(*writer), monitor));
}

std::size_t BoxRecorder::add(std::string id) {
  cameras_.emplace_back().id = std::move(id);
  return cameras_.size() - 1;
}

void BoxRecorder::keep(std::size_t camera, const Detections& boxes) {
  Detections* place = cameras_[camera].waiting.back();
  if (place == nullptr) {
    ++cameras_[camera].lost;
    return;
  }
  *place = boxes;
  cameras_[camera].waiting.push();
}

void BoxRecorder::take_over() {
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    for (; const Detections* boxes = cameras_[i].waiting.front(); cameras_[i].waiting.pop())
      lines_.push_back({i, *boxes});
  std::ranges::stable_sort(lines_, {}, [](const Line& line) { return std::pair(line.boxes.stamp, line.camera); });
}

void BoxRecorder::write_until(Time stamp, Time now) {
  std::size_t done = 0;
  for (; done < lines_.size() && lines_[done].boxes.stamp <= stamp; ++done) {
    if (failed_) continue;
    const auto written = writer_.write(cameras_[lines_[done].camera].id, lines_[done].boxes);
    failed_ = !written;
    if (failed_) monitor_.event(now, "recording", "boxes are no longer kept: " + to_string(written.error()));
  }
  lines_.erase(lines_.begin(), lines_.begin() + static_cast<std::ptrdiff_t>(done));
  if (done == 0 || failed_) return;
  const auto flushed = writer_.flush();  // what a core that dies has said is in the recording
  failed_ = !flushed;
  if (failed_) monitor_.event(now, "recording", "boxes are no longer kept: " + to_string(flushed.error()));
}

void BoxRecorder::write_waiting(Time now) {
  take_over();
  if (!lines_.empty()) write_until(lines_.back().boxes.stamp - kPatience, now);
  std::uint64_t lost = 0;
  for (const Camera& camera : cameras_) lost += camera.lost;
  if (lost != std::exchange(reported_, lost))
    monitor_.event(now, "recording", "boxes were lost to the recording: the disk was too slow");
}

void BoxRecorder::close(Time now) {
  take_over();
  write_until(Time::max(), now);
  if (failed_) return;
  if (const auto closed = writer_.close(); !closed)
    monitor_.event(now, "recording", "boxes were not kept whole: " + to_string(closed.error()));
}

}  // namespace cairn::app
