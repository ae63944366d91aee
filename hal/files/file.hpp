// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "hal/files/file_calls.hpp"
#include "hal/result.hpp"

namespace cairn {

/// The bytes of a whole file. A file above `max_bytes` is refused before memory is taken. Errors: those of
/// InputFile::open(), kIo, kLimit.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes);

/// Replaces a file so that it always has the whole old or the whole new content: writes a temporary file beside `path`,
/// syncs it, renames it to `path` and syncs the folder. On an error (kIo) the old file is unchanged and the temporary
/// one is removed.
Result<void> write_file_atomic(const std::filesystem::path& path, std::span<const std::byte> bytes,
                               FileCalls& calls = FileCalls::machine());
/// The same for a text.
Result<void> write_file_atomic(const std::filesystem::path& path, std::string_view text);
/// The same without any sync: the file is whole if the program dies, but not if the machine loses power. For files that
/// are written often and are worth nothing after a reboot.
Result<void> replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                          FileCalls& calls = FileCalls::machine());

}  // namespace cairn
