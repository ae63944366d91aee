// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/bytes.hpp"

namespace cairn::peers {

inline void append_varint(std::vector<std::byte>& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::byte>(value | 0x80));
  out.push_back(static_cast<std::byte>(value));
}
[[nodiscard]] inline std::size_t varint_bytes(std::uint64_t value) {
  return (static_cast<std::size_t>(std::bit_width(value | 1)) + 6) / 7;
}

/// Small numbers of either sign as small ones: 0, −1, 1, −2 … as 0, 1, 2, 3 …
[[nodiscard]] constexpr std::uint64_t zigzag(std::int64_t value) {
  return static_cast<std::uint64_t>(value) << 1U ^ static_cast<std::uint64_t>(value >> 63);
}
[[nodiscard]] constexpr std::int64_t unzigzag(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
}

/// Nothing for bytes that append_varint() cannot have written.
[[nodiscard]] inline std::optional<std::uint64_t> read_varint(ByteReader& in) {
  const auto first = in.read<std::uint8_t>();
  if (!first || *first < 0x80) return first;
  std::uint64_t value = *first & 0x7FU;
  for (unsigned shift = 7; shift < 64; shift += 7) {
    const auto byte = in.read<std::uint8_t>();
    if (!byte) return std::nullopt;
    const std::uint64_t bits = *byte & 0x7FU;
    if (shift == 63 && bits > 1) return std::nullopt;
    value |= bits << shift;
    if ((*byte & 0x80U) == 0) return bits == 0 ? std::nullopt : std::optional(value);
  }
  return std::nullopt;
}

}  // namespace cairn::peers
