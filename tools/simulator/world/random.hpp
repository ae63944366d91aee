// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

namespace cairn::simulator {

/// The finaliser of SplitMix64 (Steele, Lea, Flood, 2014): every input bit changes every output bit with p ≈ 1/2.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A counter-based random generator: the numbers follow from (seed, stream, index) alone, so each laser shot can have
/// its own generator and the bytes do not depend on who draws first. The standard library's distributions differ from
/// vendor to vendor; these do not.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed, std::uint64_t stream = 0, std::uint64_t index = 0)
      : key_(mix(mix(mix(seed) ^ stream) ^ index)) {}

  [[nodiscard]] constexpr std::uint64_t next() { return mix(key_ + counter_++); }

  /// In [0, 1).
  [[nodiscard]] constexpr double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  [[nodiscard]] constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, n); n > 0.
  [[nodiscard]] constexpr std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(n));
  }
  /// Two independent draws from N(0, 1), by Box and Muller.
  [[nodiscard]] std::pair<double, double> normal_pair() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace cairn::simulator
