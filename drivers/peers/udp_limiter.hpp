// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace cairn::peer_link {

/// A cap on all that this process sends over the network: also the DDS library's discovery, heartbeats and answers. The
/// program's own sendmsg() stands before the C library's. Datagrams to an internet address beyond the cap are dropped,
/// as on a bad link; data before discovery. It works only in programs that link udp_limiter.cpp.
struct UdpLimits {
  std::size_t bytes_per_second = 0;  ///< UDP, IP and Ethernet headers included; 0: no cap
};
void limit_udp(const UdpLimits& limits);

/// Whether a datagram of data would pass now; `bytes` include the headers.
[[nodiscard]] bool udp_room(std::size_t bytes);

/// What this process sent over the network.
struct UdpCounters {
  std::uint64_t sent_bytes = 0, sent = 0, dropped = 0;
};
[[nodiscard]] UdpCounters udp_counters();

}  // namespace cairn::peer_link
