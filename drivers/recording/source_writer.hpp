// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/packet.hpp"
#include "hal/result.hpp"

namespace cairn::recording {

/// Writes the packets of one source into the native file of its kind.
class SourceWriter {
 public:
  virtual ~SourceWriter() = default;
  /// Appends one packet. Errors: kIo, and those of packets that the format cannot hold.
  virtual Result<void> write(const Packet& packet) = 0;
  /// Hands everything buffered to the operating system.
  virtual Result<void> flush() = 0;
  /// Flushes, syncs and closes. Returns the error of any write.
  virtual Result<void> close() = 0;
};

/// Makes the folders and files of source `index` in `dir`.
[[nodiscard]] Result<std::unique_ptr<SourceWriter>> open_source_writer(const std::filesystem::path& dir,
                                                                       const Recording& recording, std::size_t index);

/// The files of this source that exist in `dir`: its own file, and the files that it lists.
[[nodiscard]] std::vector<std::filesystem::path> existing_files(const std::filesystem::path& dir,
                                                                const SourceEntry& entry);

}  // namespace cairn::recording
