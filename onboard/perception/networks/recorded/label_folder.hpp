// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "hal/ports.hpp"
#include "hal/result.hpp"

// A folder with labels/STAMP.png for each picture that was labelled. STAMP is the picture's stamp in nanoseconds on the
// recording's time line. The pictures are of label_picture.hpp's forms.
namespace cairn::networks {

inline constexpr const char* kLabelFolder = "labels";  ///< beside recording.yaml

/// The labels of one picture: `folder`/STAMP.png.
[[nodiscard]] std::filesystem::path label_file(const std::filesystem::path& folder, Time stamp);

/// Answers with what is in such a folder.
class RecordedSegmenter final : public Segmenter {
 public:
  /// `folder`: the one with the pictures, such as RECORDING/labels.
  explicit RecordedSegmenter(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Errors: kNotFound (no labels of this picture are there); those of decode_label_picture() and read_file().
  Result<const LabelImage*> segment(const Image& picture) override;

 private:
  std::filesystem::path folder_;
  LabelImage labels_;
};

/// Writes such a folder. Each file is whole or not there.
class LabelFolderWriter {
 public:
  /// Makes `folder` where it is missing. Error kIo.
  [[nodiscard]] static Result<LabelFolderWriter> create(std::filesystem::path folder);

  /// Errors: kMalformed (the labels have no pixels, or fewer than their size says), kIo.
  [[nodiscard]] Result<void> write(const LabelImage& labels);

 private:
  explicit LabelFolderWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::filesystem::path folder_;
  std::vector<std::byte> encoded_;
};

}  // namespace cairn::networks
