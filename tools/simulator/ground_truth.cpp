// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/ground_truth.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "drivers/camera/picture_file.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/files/file.hpp"

namespace cairn::simulator {

Result<void> GroundTruth::open_lidar_labels() {
  auto created = AppendFile::create(dir_ / "lidar_labels.bin");
  if (!created) return created.error();
  lidar_labels_ = std::move(*created);
  return {};
}

Result<void> GroundTruth::add_lidar_labels(std::span<const std::byte> classes) {
  lidar_labels_->buffer().insert(lidar_labels_->buffer().end(), classes.begin(), classes.end());
  return lidar_labels_->end_record();
}

Result<void> GroundTruth::open_picture_labels() {
  std::error_code code;
  std::filesystem::create_directories(dir_ / "labels", code);
  if (code) return Error{Errc::kIo, "cannot make the folder", (dir_ / "labels").string(), {}, code.message()};
  return {};
}

Result<void> GroundTruth::add_picture_labels(Time t, const Lens& lens, const std::vector<std::byte>& classes) {
  const auto width = static_cast<std::uint32_t>(lens.width), height = static_cast<std::uint32_t>(lens.height);
  const auto frame = camera::check_frame(
      {static_cast<std::uint32_t>(camera::FrameFormat::kGrey), width, height, width, false}, classes);
  if (!frame) return frame.error();
  if (auto encoded = camera::frame_to_picture(*frame, encoded_); !encoded) return encoded.error();
  auto file = AppendFile::create(dir_ / "labels" / (std::to_string(t.time_since_epoch().count()) + ".png"));
  if (!file) return file.error();
  file->buffer() = encoded_;
  if (auto written = file->end_record(); !written) return written;
  return file->close(false);
}

void GroundTruth::add_boxes(const std::string& camera, Time t, std::vector<Detection> people) {
  boxes_.push_back({t, camera, std::move(people)});
}

/// A line's order is that of its stamp, but cameras are recorded one after the other.
Result<void> GroundTruth::write_boxes() {
  if (boxes_.empty()) return {};
  std::ranges::stable_sort(boxes_, {}, &networks::RecordedBoxes::stamp);
  std::string text(networks::kBoxHeader);
  for (const networks::RecordedBoxes& picture : boxes_) text += networks::to_csv(picture);
  return write_file_atomic(dir_ / "true_boxes.csv", text);
}

Result<void> GroundTruth::write(const Trajectory& trajectory) {
  if (lidar_labels_) {
    if (auto closed = lidar_labels_->close(); !closed) return closed;
  }
  if (auto written = write_boxes(); !written) return written;
  std::vector<recording::StampedPose> poses;
  for (std::size_t i = 0; i < trajectory.knots().size(); ++i) {
    poses.push_back({trajectory.knot_time(i), SE3::from_xyz_rpy(trajectory.knots()[i])});
  }
  if (auto written = recording::write_tum(dir_ / "ground_truth.tum", poses); !written) return written;
  if (stage_.people.size() > 0) {
    if (auto written = write_file_atomic(dir_ / "people.csv", stage_.people.to_csv()); !written) return written;
  }
  return write_file_atomic(dir_ / "world.ot", stage_.world_ot);
}

}  // namespace cairn::simulator
