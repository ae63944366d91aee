// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/source_writer.hpp"
#include "hal/packet.hpp"
#include "hal/result.hpp"

namespace cairn::recording {

/// Writes a recording folder. The index is written first, as that of an unfinished recording, and the files grow by
/// whole records. So a recording whose program was killed can be read up to its last flush(), and says what it is.
class RecordingWriter {
 public:
  /// Makes the folder, recording.yaml and the files of all sources. An existing recording, or a file that would be
  /// replaced, is refused (kIo).
  [[nodiscard]] static Result<RecordingWriter> create(const std::filesystem::path& dir, const Recording& recording);

  /// Appends the packet to the file of its source: a datagram to the port in `channel`, a sweep with the ScanLayout in
  /// `channel`, a picture, a CAN frame, or an edge of a line. After an error the caller may go on with other sources;
  /// what was written before is kept.
  [[nodiscard]] Result<void> write(const Packet& packet);
  /// Hands everything buffered to the operating system; call it about once a second.
  [[nodiscard]] Result<void> flush();
  /// Flushes, syncs and closes all files; the first error of any of them. Without one, the recording is finished.
  [[nodiscard]] Result<void> close();

  /// How much was written.
  struct Written {
    std::uint64_t packets = 0, payload_bytes = 0;
  };
  /// Of each source, in the recording's order.
  [[nodiscard]] const std::vector<Written>& written() const { return written_; }
  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  [[nodiscard]] std::uint64_t payload_bytes() const { return payload_bytes_; }

 private:
  RecordingWriter(std::filesystem::path dir, const Recording& recording)
      : dir_(std::move(dir)), recording_(recording), written_(recording.sources.size()) {}
  Result<void> open_outputs();

  std::filesystem::path dir_;
  Recording recording_;
  std::vector<std::unique_ptr<SourceWriter>> outputs_;  // one per source, in its order
  std::vector<Written> written_;
  std::uint64_t packets_ = 0, payload_bytes_ = 0;
};

}  // namespace cairn::recording
