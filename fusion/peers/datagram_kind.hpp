// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace cairn::peers {

/// Second byte of a datagram.
enum class DatagramKind : std::uint8_t { kHello = 1, kDigest = 2, kItems = 3 };
inline constexpr std::size_t kHeaderBytes = 10;  ///< format, kind, sender

}  // namespace cairn::peers
