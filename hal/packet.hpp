// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/time.hpp"

namespace cairn {

/// Which source of the robot profile a packet came from: its index in the list of sources.
enum class SourceId : std::uint16_t {};

/// Bytes from outside, before anyone looked at them. Everything enters as a Packet, live and in replay.
struct Packet {
  SourceId source{};
  std::uint16_t channel = 0;     ///< for UDP the destination port; otherwise defined by the source
  std::uint64_t sequence = 0;    ///< counts up per source; gaps are losses before this program
  Time arrival{};                ///< when the bytes reached this computer (kernel stamp where there is one)
  bool truncated = false;        ///< the transport delivered fewer bytes than were sent (MSG_TRUNC, caplen < len)
  std::vector<std::byte> bytes;  ///< the payload alone, without transport headers

  [[nodiscard]] std::span<const std::byte> payload() const { return bytes; }
};

}  // namespace cairn
