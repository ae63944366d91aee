// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/frame.hpp"

#include <algorithm>

#include "hal/bytes.hpp"

namespace cairn::velodyne {
namespace {

constexpr std::uint16_t kIpv4 = 0x0800;
constexpr int kMaxVlanTags = 4;

std::uint16_t be16(std::span<const std::byte> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(load_le<std::uint8_t>(bytes, at) << 8 | load_le<std::uint8_t>(bytes, at + 1));
}
std::uint32_t be32(std::span<const std::byte> bytes, std::size_t at) {
  return std::uint32_t{be16(bytes, at)} << 16 | be16(bytes, at + 2);
}
bool is_vlan(std::uint16_t protocol) { return protocol == 0x8100 || protocol == 0x88A8 || protocol == 0x9100; }

Error cut_at(std::size_t offset) { return {Errc::kTruncated, "capture ends inside a header", {}, offset, {}}; }
Error unsupported(std::string_view what, std::size_t offset) { return {Errc::kUnsupported, what, {}, offset, {}}; }
Error malformed(std::string_view what, std::size_t offset) { return {Errc::kMalformed, what, {}, offset, {}}; }

/// Where the IPv4 header begins, when the link layer's protocol field at `at` and what follows lead there.
Result<std::size_t> after_protocol(std::span<const std::byte> frame, std::size_t at) {
  for (int tags = 0; tags <= kMaxVlanTags; ++tags, at += 4) {
    if (frame.size() < at + 2) return cut_at(frame.size());
    const std::uint16_t protocol = be16(frame, at);
    if (protocol == kIpv4) return at + 2;
    if (!is_vlan(protocol)) return unsupported("frame does not carry IPv4", at);
  }
  return unsupported("frame has too many VLAN tags", at - 4);
}

/// A loopback frame begins with the address family, in the byte order of whoever captured it.
Result<std::size_t> after_family(std::span<const std::byte> frame) {
  if (frame.size() < 4) return cut_at(frame.size());
  if (load_le<std::uint32_t>(frame, 0) != 2 && be32(frame, 0) != 2) return unsupported("frame does not carry IPv4", 0);
  return 4;
}

/// SLL2 has its protocol field first and the payload after the whole header of 20 bytes.
Result<std::size_t> after_sll2(std::span<const std::byte> frame) {
  constexpr std::size_t kHeader = 20;
  if (frame.size() < kHeader) return cut_at(frame.size());
  if (be16(frame, 0) == kIpv4) return kHeader;
  if (is_vlan(be16(frame, 0))) return after_protocol(frame, kHeader + 2);
  return unsupported("frame does not carry IPv4", 0);
}

Result<std::size_t> ip_header(int link_type, std::span<const std::byte> frame) {
  constexpr std::size_t kEthernetProtocol = 12, kSllProtocol = 14;
  switch (link_type) {
    case kLinkEthernet:
      return after_protocol(frame, kEthernetProtocol);
    case kLinkSll:
      return after_protocol(frame, kSllProtocol);
    case kLinkSll2:
      return after_sll2(frame);
    case kLinkNull:
      return after_family(frame);
    case kLinkRaw:
    case kLinkRawDlt:
    case kLinkIpv4:
      return 0;
    default:
      return unsupported("link type is not supported", 0);
  }
}

/// The UDP part of an IPv4 packet that begins at `ip`. Padding behind the packet is cut off; `wire_size` is how long
/// the part was before the capture cut it.
struct UdpPart {
  std::size_t begin;
  std::size_t wire_size;
};
Result<UdpPart> udp_part(std::span<const std::byte> frame, std::size_t ip) {
  constexpr std::size_t kMinIpHeader = 20;
  constexpr std::uint8_t kUdp = 17;
  if (frame.size() < ip + kMinIpHeader) return cut_at(frame.size());
  const auto version_and_length = load_le<std::uint8_t>(frame, ip);
  if (version_and_length >> 4 != 4) return unsupported("frame does not carry IPv4", ip);
  const std::size_t header = (version_and_length & 0x0FU) * std::size_t{4};
  if (header < kMinIpHeader) return malformed("IPv4 header is shorter than 20 bytes", ip);
  if (load_le<std::uint8_t>(frame, ip + 9) != kUdp) return unsupported("packet is not UDP", ip + 9);
  constexpr std::uint16_t kMoreFragmentsOrOffset = 0x3FFF;
  if ((be16(frame, ip + 6) & kMoreFragmentsOrOffset) != 0) return unsupported("packet is a fragment", ip + 6);
  // Zero: the network card was to fill it in after the capture.
  const std::size_t written = be16(frame, ip + 2);
  const std::size_t total = written == 0 ? frame.size() - ip : written;
  if (total < header) return malformed("IPv4 packet is shorter than its header", ip + 2);
  return UdpPart{ip + header, total - header};
}

}  // namespace

Result<Datagram> udp_in_frame(int link_type, std::span<const std::byte> frame) {
  constexpr std::size_t kUdpHeader = 8;
  const auto ip = ip_header(link_type, frame);
  if (!ip) return ip.error();
  const auto part = udp_part(frame, *ip);
  if (!part) return part.error();
  const std::size_t udp = part->begin;
  if (frame.size() < udp + kUdpHeader) return cut_at(frame.size());
  const std::size_t length = be16(frame, udp + 4);
  if (length < kUdpHeader || length > part->wire_size)
    return malformed("UDP length does not fit the packet that carries it", udp + 4);
  const std::size_t there = std::min(length, frame.size() - udp) - kUdpHeader;
  return Datagram{be32(frame, *ip + 12), be16(frame, udp), be16(frame, udp + 2), there + kUdpHeader < length,
                  frame.subspan(udp + kUdpHeader, there)};
}

}  // namespace cairn::velodyne
