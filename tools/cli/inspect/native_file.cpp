// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/native_file.hpp"

#include <array>
#include <fstream>
#include <string>

#include "drivers/drive/can/candump.hpp"
#include "drivers/gpio/line_event.hpp"
#include "drivers/recording/formats/image_folder.hpp"
#include "hal/files/input_file.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

bool begins_as(const std::string& line, std::string_view header) {
  return line.starts_with(header.substr(0, header.size() - 1));  // without its line feed
}

/// The first line that is no comment, cut to what any of these files may have in one. A list's header is no comment.
std::string first_line(const fs::path& path) {
  constexpr int kLooked = 64;
  auto opened = open_input_stream(path);
  if (!opened) return {};
  std::ifstream file = std::move(*opened);
  std::array<char, drive::kMaxCandumpLine> line{};
  for (int i = 0; i < kLooked && file; ++i) {
    file.getline(line.data(), static_cast<std::streamsize>(line.size()));
    const std::string text(line.data());
    const bool comment = text.starts_with('#') && !begins_as(text, recording::kImageIndexHeader);
    if (!comment && text.find_first_not_of(" \t\r") != std::string::npos) return text;
  }
  return {};
}

bool is_candump(const std::string& line) {
  const auto parsed = drive::parse_candump(line);
  return parsed && *parsed;
}

bool lists_pictures(const std::string& line) {
  std::vector<recording::ImageIndexEntry> entries;
  return begins_as(line, recording::kImageIndexHeader) ||
         (recording::parse_image_index(line, "", entries) && !entries.empty());
}

recording::SensorKind kind_of_pictures(const fs::path& folder) {
  const std::string name = folder.filename().string();
  if (name.find("thermal") != std::string::npos) return recording::kThermal;
  return name.find("depth") != std::string::npos ? recording::kDepth : recording::kCamera;
}

}  // namespace

bool says_depth(const fs::path& pictures) {
  std::error_code error;
  const fs::path absolute = fs::absolute(pictures, error);
  return absolute.filename().string().find("depth") != std::string::npos ||
         kind_of_pictures(absolute.parent_path()) == recording::kDepth;
}

std::optional<NativeFile> recognise_native_file(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path folder = absolute.parent_path();
  NativeFile file{folder, {}};
  recording::SourceEntry entry;
  entry.id = "source";
  entry.file = absolute.filename().string();
  const std::string line = first_line(path);
  if (begins_as(line, gpio::kCsvHeader)) {
    entry.kind = recording::kGpio;
  } else if (lists_pictures(line)) {
    entry.kind = kind_of_pictures(folder);
    file.dir = folder.parent_path();
    entry.file = (folder.filename() / entry.file).string();
  } else if (is_candump(line)) {
    entry.kind = recording::kDrive;
  } else {
    return std::nullopt;
  }
  file.recording.sources.push_back(entry);
  return file;
}

}  // namespace cairn::cli
