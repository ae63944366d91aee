// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/recorded/label_folder.hpp"

#include <string>
#include <system_error>

#include "hal/files/file.hpp"
#include "onboard/perception/networks/recorded/label_picture.hpp"

namespace cairn::networks {

namespace fs = std::filesystem;

fs::path label_file(const fs::path& folder, Time stamp) {
  return folder / (std::to_string(stamp.time_since_epoch().count()) + ".png");
}

Result<const LabelImage*> RecordedSegmenter::segment(const Image& picture) {
  const fs::path path = label_file(folder_, picture.stamp);
  const auto file = read_file(path, kMaxLabelFileBytes);
  if (!file) return file.error();
  if (auto decoded = decode_label_picture(*file, labels_); !decoded) return at(path.string(), decoded.error());
  labels_.source = picture.source;
  labels_.stamp = picture.stamp;
  return &labels_;
}

Result<LabelFolderWriter> LabelFolderWriter::create(fs::path folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{Errc::kIo, "cannot create the folder", folder.string(), {}, error.message()};
  return LabelFolderWriter(std::move(folder));
}

Result<void> LabelFolderWriter::write(const LabelImage& labels) {
  const fs::path path = label_file(folder_, labels.stamp);
  const bool sized =
      labels.width > 0 && labels.height > 0 && labels.width <= kMaxLabelSide && labels.height <= kMaxLabelSide;
  if (!sized || labels.classes.size() != labels.index(0, labels.height) ||
      labels.probabilities.size() != labels.classes.size())
    return Error{Errc::kMalformed, "labels do not have the pixels that their size says", path.string(), {}, {}};
  if (auto encoded = encode_label_picture(labels, encoded_); !encoded) return at(path.string(), encoded.error());
  return replace_file(path, encoded_);
}

}  // namespace cairn::networks
