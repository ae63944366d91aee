// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/link_frame.hpp"

#include <xxhash.h>

#include "hal/bytes.hpp"

namespace cairn::peer_link {
namespace {

constexpr std::uint32_t kMagic = 0x314C5043;  // "CPL1"
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kChecksumAt = 16;

/// Of a message as if its checksum were 0.
std::uint32_t checksum(std::span<const std::byte> message) {
  const std::uint32_t head = XXH32(message.data(), kChecksumAt, 0);
  return XXH32(message.data() + LinkFrame::kHeaderBytes, message.size() - LinkFrame::kHeaderBytes, head);
}

}  // namespace

void encode(const LinkFrame& frame, std::vector<std::byte>& out) {
  out.clear();
  append_le(out, kMagic);
  append_le(out, kVersion);
  append_le(out, static_cast<std::uint8_t>(frame.kind));
  append_le(out, static_cast<std::uint16_t>(frame.bytes.size()));
  append_le(out, frame.robot);
  append_le(out, std::uint32_t{0});
  out.insert(out.end(), frame.bytes.begin(), frame.bytes.end());
  const std::uint32_t sum = checksum(out);
  std::memcpy(out.data() + kChecksumAt, &sum, sizeof sum);
}

Result<LinkFrame> decode_link_frame(std::span<const std::byte> message) {
  if (message.size() < LinkFrame::kHeaderBytes) return Error{Errc::kTruncated, "a frame shorter than its header"};
  if (load_le<std::uint32_t>(message, 0) != kMagic)
    return Error{Errc::kMalformed, "not a frame of the peer link", {}, 0};
  if (load_le<std::uint8_t>(message, 4) != kVersion)
    return Error{
        Errc::kUnsupported, "another version of the peer link", {}, 4, "core and peer process must be of one release"};
  const auto kind = load_le<std::uint8_t>(message, 5);
  const std::size_t length = load_le<std::uint16_t>(message, 6);
  if (kind < 1 || kind > 2 || length > LinkFrame::kMaxBytes || length != message.size() - LinkFrame::kHeaderBytes)
    return Error{Errc::kMalformed, "a frame whose header cannot be", {}, 5};
  if (load_le<std::uint32_t>(message, kChecksumAt) != checksum(message))
    return Error{Errc::kMalformed, "the checksum of a frame differs", {}, kChecksumAt};
  return LinkFrame{static_cast<LinkFrame::Kind>(kind), load_le<std::uint64_t>(message, 8),
                   message.subspan(LinkFrame::kHeaderBytes)};
}

}  // namespace cairn::peer_link
