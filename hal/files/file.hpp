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

/// The whole file, or an error; a file above `max_bytes` is refused before anything is allocated.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes);

/// Old content or new content, never neither and never half: writes a temporary file beside `path`, syncs it, renames
/// it over `path` and syncs the folder. On an error the old file is untouched and the temporary one is gone.
Result<void> write_file_atomic(const std::filesystem::path& path, std::span<const std::byte> bytes,
                               FileCalls& calls = FileCalls::machine());
Result<void> write_file_atomic(const std::filesystem::path& path, std::string_view text);
/// The same without any sync: whole whenever the program dies, but not when the machine does. For what is written
/// often and is worth nothing after a reboot.
Result<void> replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                          FileCalls& calls = FileCalls::machine());

}  // namespace cairn
