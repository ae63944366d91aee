// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.hpp"

namespace cairn::velodyne {

/// A UDP/IPv4 datagram inside a captured frame.
struct Datagram {
  std::uint32_t source_address = 0;  ///< host byte order: 192.168.1.201 is 0xC0A801C9
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  bool truncated = false;              ///< `payload` is shorter than it was on the wire
  std::span<const std::byte> payload;  ///< in the frame's memory
};

/// Link types as libpcap numbers them (DLT_ / LINKTYPE_) that udp_in_frame understands.
inline constexpr int kLinkNull = 0, kLinkEthernet = 1, kLinkRawDlt = 12, kLinkRaw = 101, kLinkSll = 113,
                     kLinkIpv4 = 228, kLinkSll2 = 276;

/// Finds the UDP datagram in a captured frame. Reads Ethernet with any number of VLAN tags, Linux cooked captures (both
/// versions), raw IP and BSD loopback. Errors name the offset: kUnsupported (not UDP over IPv4, a fragment, or an
/// unknown link type), kTruncated (the capture ends in a header), kMalformed (a header contradicts itself).
[[nodiscard]] Result<Datagram> udp_in_frame(int link_type, std::span<const std::byte> frame);

}  // namespace cairn::velodyne
