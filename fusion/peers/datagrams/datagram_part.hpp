// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace cairn::peers {

/// Bits of a datagram's second byte.
enum DatagramPart : std::uint8_t { kHelloPart = 1, kDigestPart = 2, kItemsPart = 4, kBodiesPart = 8, kAllParts = 15 };
inline constexpr std::size_t kHeaderBytes = 10;  ///< format, parts, sender

/// Of a robot's name: names are shown to people, and must not be able to write on their terminals.
[[nodiscard]] constexpr bool is_printable(char c) { return c >= ' ' && c <= '~'; }

}  // namespace cairn::peers
