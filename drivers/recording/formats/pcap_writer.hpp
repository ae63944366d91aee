// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

#include "hal/files/append_file.hpp"
#include "hal/result.hpp"

namespace cairn::recording {

/// An IPv4 address, most significant byte first: {192, 168, 1, 201}.
using Ipv4 = std::array<std::uint8_t, 4>;

/// Writes UDP datagrams as a capture file that tcpdump, Wireshark and VeloView open: classic pcap with nanosecond
/// stamps (magic 0xA1B23C4D), little-endian, link type Ethernet. The same calls give the same bytes. If a write fails,
/// the file is cut back to its last whole record. Format: https://www.tcpdump.org/manpages/pcap-savefile.5.html
class PcapWriter {
 public:
  /// Creates or empties `path`.
  [[nodiscard]] static Result<PcapWriter> create(const std::filesystem::path& path);
  /// Appends one datagram. `utc_ns`: nanoseconds since 1970, 0 … kMaxUtcNs. `truncated` marks a payload of which the
  /// transport delivered only the beginning; it is recorded as caplen < len. At most kMaxPayload bytes.
  /// After an I/O error every further call returns that error.
  [[nodiscard]] Result<void> write(std::int64_t utc_ns, Ipv4 source_ip, std::uint16_t destination_port,
                                   std::span<const std::byte> payload, bool truncated = false);
  /// Hands everything buffered to the operating system.
  [[nodiscard]] Result<void> flush() { return file_.flush(); }
  /// Flushes, syncs to the disk and closes. Returns the error of any write since create().
  [[nodiscard]] Result<void> close() { return file_.close(); }

  [[nodiscard]] std::uint64_t packets() const { return packets_; }  ///< accepted so far

  static constexpr std::size_t kMaxPayload = 65'000;

 private:
  explicit PcapWriter(AppendFile file) : file_(std::move(file)) {}

  AppendFile file_;
  std::uint64_t packets_ = 0;
};

}  // namespace cairn::recording
