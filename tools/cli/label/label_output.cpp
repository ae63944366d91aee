// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/label/label_output.hpp"

#include <algorithm>
#include <system_error>

#include "hal/files/file.hpp"
#include "onboard/perception/networks/overlay/overlay.hpp"
#include "onboard/perception/networks/recorded/box_file.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOverlayFolder = "overlay";
constexpr double kOpacity = 0.5;
constexpr int kWide = 640;  // pixels; thermal pictures have 160

Result<void> make_room(const fs::path& path, bool overwrite) {
  std::error_code error;
  if (!fs::exists(path, error)) return {};
  if (!overwrite)
    return Error{Errc::kInvalidConfig,
                 "labels are there already",
                 path.string(),
                 {},
                 "name another folder with --out, or replace them with --overwrite"};
  fs::remove_all(path, error);
  if (error) return Error{Errc::kIo, "cannot be removed", path.string(), {}, error.message()};
  return {};
}

}  // namespace

Result<LabelOutput> LabelOutput::create(const fs::path& folder, bool overlays, bool overwrite) {
  if (folder.empty()) return LabelOutput({}, false);
  for (const char* name : {networks::kLabelFolder, networks::kBoxFile, kOverlayFolder})
    if (auto made = make_room(folder / name, overwrite); !made) return made.error();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{Errc::kIo, "cannot create the folder", folder.string(), {}, error.message()};
  return LabelOutput(folder, overlays);
}

Result<void> LabelOutput::keep(const LabelImage& labels) {
  if (folder_.empty()) return {};
  if (!labels_) {
    auto writer = networks::LabelFolderWriter::create(folder_ / networks::kLabelFolder);
    if (!writer) return writer.error();
    labels_ = std::move(*writer);
  }
  return labels_->write(labels);
}

void LabelOutput::keep(const std::string& camera, const Detections& detections) {
  if (!folder_.empty()) boxes_.emplace_back(camera, detections);
}

Result<void> LabelOutput::keep_overlay(const std::string& camera, const Image& picture, const LabelImage* labels,
                                       const Detections* detections) const {
  if (folder_.empty() || !overlays_) return {};
  Image painted;
  if (auto made = networks::to_colour(picture, kWide, painted); !made) return made;
  if (labels != nullptr) networks::paint_labels(*labels, kOpacity, painted);
  if (detections != nullptr) networks::paint_boxes(*detections, painted);
  if (labels != nullptr) networks::add_legend(*labels, painted);
  const auto png = networks::encode_png(painted);
  if (!png) return png.error();
  const fs::path path = networks::label_file(folder_ / kOverlayFolder / camera, picture.stamp);
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return Error{Errc::kIo, "cannot create the folder", path.parent_path().string(), {}, error.message()};
  return replace_file(path, *png);
}

/// Cameras with different latencies do not answer in the order of their exposures.
Result<void> LabelOutput::finish() {
  if (boxes_.empty()) return {};
  std::stable_sort(boxes_.begin(), boxes_.end(),
                   [](const auto& a, const auto& b) { return a.second.stamp < b.second.stamp; });
  auto writer = networks::BoxWriter::create(folder_ / networks::kBoxFile);
  if (!writer) return writer.error();
  for (const auto& [camera, detections] : boxes_)
    if (auto written = writer->write(camera, detections); !written) return written;
  return writer->close();
}

}  // namespace cairn::cli
