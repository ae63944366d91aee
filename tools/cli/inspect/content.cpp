// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/content.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "drivers/recording/formats/recording.hpp"
#include "hal/files/input_file.hpp"
#include "tools/cli/inspect/data_file.hpp"
#include "tools/cli/inspect/folder.hpp"
#include "tools/cli/inspect/native_file.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

/// Which options change anything.
struct Taken {
  Content content;
  std::string_view what;
  bool model = false;
  bool scan = false;         ///< --out and --scan
  bool calibration = false;  ///< --out, --as and --camera
};

constexpr std::array kTaken{
    Taken{.content = Content::kRecording, .what = "a recording", .model = true, .scan = true},
    Taken{.content = Content::kRun, .what = "a run"},
    Taken{.content = Content::kFolder, .what = "a folder without a recording.yaml"},
    Taken{.content = Content::kCapture, .what = "a capture", .model = true, .scan = true},
    Taken{.content = Content::kPicture, .what = "a picture"},
    Taken{.content = Content::kNativeFile, .what = "a file of a recording", .model = true, .scan = true},
    Taken{.content = Content::kCloud, .what = "a point cloud", .scan = true},
    Taken{.content = Content::kPictures, .what = "an array of pictures", .model = true, .scan = true},
    Taken{.content = Content::kNumbers, .what = "an array of numbers"},
    Taken{.content = Content::kSweep, .what = "a sweep", .scan = true},
    Taken{.content = Content::kMap, .what = "a map"},
    Taken{.content = Content::kTrajectory, .what = "a trajectory"},
    Taken{.content = Content::kCalibration, .what = "a calibration", .calibration = true},
};

bool is_capture(InputFile& file) {
  std::array<unsigned char, 4> magic{};
  (void)file.read(std::as_writable_bytes(std::span(magic)));
  using Magic = std::array<unsigned char, 4>;
  for (const Magic& known :
       {Magic{0xD4, 0xC3, 0xB2, 0xA1}, Magic{0xA1, 0xB2, 0xC3, 0xD4}, Magic{0x4D, 0x3C, 0xB2, 0xA1},
        Magic{0xA1, 0xB2, 0x3C, 0x4D}, Magic{0x0A, 0x0D, 0x0D, 0x0A}})
    if (magic == known) return true;
  return false;
}

Content content_of_folder(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path / recording::kIndexFile, error)) return Content::kRecording;
  return is_run(path) ? Content::kRun : Content::kFolder;
}

Content content_by_ending(const std::string& ending) {
  constexpr std::array kEndings{std::pair{".pcd", Content::kCloud},        std::pair{".npy", Content::kPictures},
                                std::pair{".bin", Content::kSweep},        std::pair{".cairn", Content::kMap},
                                std::pair{".ot", Content::kMap},           std::pair{".bt", Content::kMap},
                                std::pair{".tum", Content::kTrajectory},   std::pair{".txt", Content::kTrajectory},
                                std::pair{".yaml", Content::kCalibration}, std::pair{".yml", Content::kCalibration}};
  const auto* known = std::ranges::find(kEndings, ending, [](const auto& e) { return std::string_view(e.first); });
  return known == kEndings.end() ? Content::kUnknown : known->second;
}

}  // namespace

Result<Content> content_of(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return content_of_folder(path);
  if (!fs::exists(path, error)) return Error{Errc::kNotFound, "there is no such file or folder", path.string(), {}, {}};
  auto input = InputFile::open(path);
  if (!input) return input.error();
  if (is_capture(*input)) return Content::kCapture;
  if (is_picture(path)) return Content::kPicture;
  if (recognise_native_file(path)) return Content::kNativeFile;
  return content_by_ending(path.extension().string());
}

Result<void> check_options(const InspectOptions& options, Content content) {
  const auto* taken = std::ranges::find(kTaken, content, &Taken::content);
  if (taken == kTaken.end()) return {};
  const bool writes = taken->scan || taken->calibration;
  for (const auto& [option, given, used] :
       {std::tuple{"--model", !options.model.empty(), taken->model}, std::tuple{"--out", !options.out.empty(), writes},
        std::tuple{"--scan", options.scan.has_value(), taken->scan},
        std::tuple{"--as", !options.as.empty(), taken->calibration},
        std::tuple{"--camera", options.camera.has_value(), taken->calibration}})
    if (given && !used)
      return Error{Errc::kInvalidConfig,
                   "would change nothing",
                   option,
                   {},
                   "this is " + std::string(taken->what) + "; leave the option out"};
  if (options.camera && options.as == "kalibr")
    return Error{Errc::kInvalidConfig,
                 "would change nothing",
                 "--camera",
                 {},
                 "a file of Kalibr's holds all cameras; leave the option out"};
  return {};
}

}  // namespace cairn::cli
