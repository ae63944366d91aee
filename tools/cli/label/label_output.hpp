// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/image.hpp"
#include "hal/labels.hpp"
#include "hal/result.hpp"
#include "onboard/perception/networks/recorded/label_folder.hpp"

namespace cairn::cli {

/// Where `cairn label` leaves its results: labels/, boxes.csv, and overlay/CAMERA/. Without a folder it leaves nothing.
class LabelOutput {
 public:
  /// `folder`: empty for none. `overlays`: pictures for people, too. What an earlier call left there is refused, or
  /// removed with `overwrite`. Errors: kInvalidConfig, kIo.
  [[nodiscard]] static Result<LabelOutput> create(const std::filesystem::path& folder, bool overlays, bool overwrite);

  [[nodiscard]] Result<void> keep(const LabelImage& labels);
  void keep(const std::string& camera, const Detections& detections);
  /// Paints what is given over the picture. `labels` and `detections` may be null.
  [[nodiscard]] Result<void> keep_overlay(const std::string& camera, const Image& picture, const LabelImage* labels,
                                          const Detections* detections) const;
  /// Writes boxes.csv, in the order of the stamps, where there were detections.
  [[nodiscard]] Result<void> finish();

 private:
  LabelOutput(std::filesystem::path folder, bool overlays) : folder_(std::move(folder)), overlays_(overlays) {}

  std::filesystem::path folder_;
  bool overlays_;
  std::optional<networks::LabelFolderWriter> labels_;
  std::vector<std::pair<std::string, Detections>> boxes_;
};

}  // namespace cairn::cli
