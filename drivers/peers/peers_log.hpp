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

// peers.log holds what a robot received from its team, in the order of arrival. All numbers are little endian. It has a
// header of 8 bytes ("CPRL", version 1 in 4 bytes). Then comes for each packet: its length (2 bytes), its PacketKind
// (2), its arrival in nanoseconds on the robot's time line (8), and its bytes.
namespace cairn::peer_link {

inline constexpr std::size_t kLogHeaderBytes = 8;

void append_log_header(std::vector<std::byte>& out);
/// Errors: kLimit (the packet is longer than kMaxPacket). Nothing is appended then.
Result<void> append_log_record(const Packet& packet, std::vector<std::byte>& out);

/// Replays peers.log, as fast as next() is called.
class PeersLogSource final : public Source {
 public:
  /// Errors: those of InputFile::open(), kMalformed (not such a file), kUnsupported (another version).
  static Result<std::unique_ptr<PeersLogSource>> open(const std::filesystem::path& path, SourceId source);
  /// The same from a stream; `name` is used in messages.
  static Result<std::unique_ptr<PeersLogSource>> from_stream(std::unique_ptr<std::istream> stream, std::string name,
                                                             SourceId source);
  /// A damaged file ends with an error: kTruncated inside its last packet, kMalformed for an invalid packet.
  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  PeersLogSource(std::unique_ptr<std::istream> file, std::string name, SourceId source)
      : file_(std::move(file)), name_(std::move(name)), source_(source) {}
  Error damaged(Errc code, const char* cause);
  [[nodiscard]] bool read(std::size_t bytes);

  std::unique_ptr<std::istream> file_;
  std::string name_;
  SourceId source_;
  std::vector<std::byte> memory_;
  std::uint64_t delivered_ = 0;
  bool ended_ = false;
};

}  // namespace cairn::peer_link
