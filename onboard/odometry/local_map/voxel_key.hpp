// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace cairn::odometry {

/// Integer cube coordinates packed into 63 bits, 21 per axis; coordinates wrap beyond ±2²⁰ cubes.
[[nodiscard]] constexpr std::uint64_t voxel_key(std::int32_t x, std::int32_t y, std::int32_t z) {
  constexpr std::uint64_t kMask = (1U << 21) - 1;
  constexpr auto bits = [](std::int32_t v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)) & kMask; };
  return bits(x) | bits(y) << 21 | bits(z) << 42;
}

/// Fibonacci hashing: the high bits of the product depend on all bits of the key.
[[nodiscard]] constexpr std::uint64_t voxel_hash(std::uint64_t key) {
  key ^= key >> 32;
  key *= 0x9E3779B97F4A7C15U;
  return key ^ key >> 29;
}

/// ⌊x⌋ without a library call (SSE2 has no rounding instruction); |x| must be below 2³⁰.
template <class Real>
[[nodiscard]] constexpr std::int32_t floor_to_int(Real x) {
  const auto i = static_cast<std::int32_t>(x);
  return i - static_cast<std::int32_t>(static_cast<Real>(i) > x);
}

}  // namespace cairn::odometry
