// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.hpp"

// What the core and the peer process send each other over their local socket: one frame in each message.
namespace cairn::peer_link {

/// One message on the local socket.
struct LinkFrame {
  enum class Kind : std::uint8_t {
    kSend = 1,      ///< core → peer process: send these bytes to `robot`, or to all if it is 0
    kReceived = 2,  ///< peer process → core: `robot` sent these bytes
  };
  static constexpr std::size_t kMaxBytes = 1200, kHeaderBytes = 20;

  Kind kind = Kind::kSend;
  std::uint64_t robot = 0;
  std::span<const std::byte> bytes;
};

/// Writes "CPL1", version 1, kind, length (2 bytes), robot (8), XXH32 of all that is before and after it (4), the
/// bytes. `out` is overwritten; its memory is reused. A frame has at most kMaxBytes.
void encode(const LinkFrame& frame, std::vector<std::byte>& out);

/// The frame's `bytes` point into `message`. Errors: kTruncated, kMalformed (also if the checksum differs),
/// kUnsupported (another version).
[[nodiscard]] Result<LinkFrame> decode_link_frame(std::span<const std::byte> message);

}  // namespace cairn::peer_link
