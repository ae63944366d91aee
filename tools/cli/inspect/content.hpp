// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "hal/result.hpp"
#include "tools/cli/inspect/inspect.hpp"

namespace cairn::cli {

/// What a file or folder holds.
enum class Content : std::uint8_t {
  kRecording,
  kRun,
  kFolder,  ///< of recordings or runs
  kCapture,
  kPicture,
  kNativeFile,  ///< of a recording: candump, gpio.csv or a list of pictures
  kCloud,
  kPictures,  ///< in an array
  kNumbers,   ///< in an array
  kSweep,
  kMap,
  kTrajectory,
  kCalibration,
  kUnknown,
};

/// By what is in the folder, by how the file begins, or by the ending of its name. An array counts as kPictures: its
/// header says whether it holds other numbers. Errors: there is no such file, or it cannot be read.
[[nodiscard]] Result<Content> content_of(const std::filesystem::path& path);

/// Options that were given and would change nothing. Error kInvalidConfig names one.
[[nodiscard]] Result<void> check_options(const InspectOptions& options, Content content);

}  // namespace cairn::cli
