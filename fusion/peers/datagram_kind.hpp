// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace cairn::peers {

/// Second byte of a datagram.
enum class DatagramKind : std::uint8_t { kHello = 1, kDigest = 2, kItems = 3 };
inline constexpr std::size_t kHeaderBytes = 10;  ///< format, kind, sender

/// Of a robot's name: names are shown to people, and must not be able to write on their terminals.
[[nodiscard]] constexpr bool is_printable(char c) { return c >= ' ' && c <= '~'; }

}  // namespace cairn::peers
