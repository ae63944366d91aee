// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "drivers/recording/formats/recording.hpp"

namespace cairn::cli {

/// A file of a recording, without the recording. Its first lines tell what it is: candump's text, gpio.csv, or the list
/// of a folder of pictures (EuRoC's data.csv; the folder's name says whether 16-bit pictures are thermal or depth).
struct NativeFile {
  std::filesystem::path dir;
  recording::Recording recording;  ///< one source, its file relative to `dir`
};

/// Null: the file is none of these.
[[nodiscard]] std::optional<NativeFile> recognise_native_file(const std::filesystem::path& path);

/// Whether the name of a file of pictures, or of its folder, says that they are depth.
[[nodiscard]] bool says_depth(const std::filesystem::path& pictures);

}  // namespace cairn::cli
