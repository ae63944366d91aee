// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "hal/files/append_file.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"
#include "tools/simulator/sensors/view.hpp"
#include "tools/simulator/stage.hpp"

namespace cairn::simulator {

/// What a simulated recording holds beside the sensors' bytes; simulate() says what the files are.
class GroundTruth {
 public:
  /// `stage` must outlive it; `dir` exists when the first file is opened.
  GroundTruth(std::filesystem::path dir, const Stage& stage) : dir_(std::move(dir)), stage_(stage) {}

  Result<void> open_lidar_labels();
  Result<void> add_lidar_labels(std::span<const std::byte> classes);
  Result<void> open_picture_labels();
  /// `classes`: one byte for each of the lens's pixels.
  Result<void> add_picture_labels(Time t, const Lens& lens, const std::vector<std::byte>& classes);
  /// Who is on a picture of a camera. `camera`: id of the recording's source.
  void add_boxes(const std::string& camera, Time t, std::vector<Detection> people);

  /// Everything else, and the end of the labels.
  Result<void> write(const Trajectory& trajectory);

 private:
  Result<void> write_boxes();

  std::filesystem::path dir_;
  const Stage& stage_;
  std::optional<AppendFile> lidar_labels_;
  std::vector<std::byte> encoded_;
  std::vector<networks::RecordedBoxes> boxes_;
};

}  // namespace cairn::simulator
