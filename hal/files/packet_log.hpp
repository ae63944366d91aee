// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "hal/packet.hpp"
#include "hal/ports.hpp"
#include "hal/result.hpp"

// A packet log holds small packets that have no file format of their own, in the order of arrival. All numbers are
// little endian. It has a header of 8 bytes (the format's magic, and its version in 4 bytes). Then comes for each
// packet: its length (2 bytes), its channel (2), its arrival in nanoseconds on the robot's time line (8), and its
// bytes.
namespace cairn {

/// What tells the logs of different sources apart.
struct PacketLogFormat {
  std::uint32_t magic = 0;
  std::size_t most_bytes = 0;  ///< of one packet; at most 65535
  std::string_view contents;   ///< for messages, such as "what peers sent"
};

inline constexpr std::size_t kPacketLogHeaderBytes = 8;

void append_log_header(const PacketLogFormat& format, std::vector<std::byte>& out);
/// Errors: kLimit (the packet is longer than the format's most_bytes). Nothing is appended then.
Result<void> append_log_record(const PacketLogFormat& format, const Packet& packet, std::vector<std::byte>& out);

/// Replays a packet log, as fast as next() is called.
class PacketLogSource final : public Source {
 public:
  /// Errors: those of open_input_stream(), kMalformed (not such a log), kUnsupported (another version).
  static Result<std::unique_ptr<PacketLogSource>> open(const std::filesystem::path& path, const PacketLogFormat& format,
                                                       SourceId source);
  /// The same from a stream; `name` is used in messages.
  static Result<std::unique_ptr<PacketLogSource>> from_stream(std::unique_ptr<std::istream> stream, std::string name,
                                                              const PacketLogFormat& format, SourceId source);
  /// A damaged file ends with an error: kTruncated inside its last packet, kMalformed for an invalid packet.
  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  PacketLogSource(std::unique_ptr<std::istream> file, std::string name, const PacketLogFormat& format, SourceId source)
      : file_(std::move(file)), name_(std::move(name)), format_(format), source_(source) {}
  Error damaged(Errc code, const char* cause);
  [[nodiscard]] bool read(std::size_t bytes);

  std::unique_ptr<std::istream> file_;
  std::string name_;
  PacketLogFormat format_;
  SourceId source_;
  std::vector<std::byte> memory_;
  std::uint64_t delivered_ = 0;
  bool ended_ = false;
};

}  // namespace cairn
