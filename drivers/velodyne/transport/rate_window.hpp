// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "hal/time.hpp"

namespace cairn::velodyne {

/// Lets so many datagrams through in each window of kLength, which begins with the first one after the last window's
/// end. Of time that runs backwards it begins a new window. Pure.
class RateWindow {
 public:
  static constexpr Duration kLength = std::chrono::milliseconds(100);

  explicit RateWindow(double most_per_s) : most_(static_cast<std::uint64_t>(most_per_s * to_seconds(kLength))) {}

  /// Whether a datagram that arrived then is wanted.
  [[nodiscard]] bool take(Time arrival) {
    if (arrival < begin_ || arrival - begin_ >= kLength) {
      begin_ = arrival;
      taken_ = 0;
    }
    return ++taken_ <= most_;
  }

 private:
  std::uint64_t most_, taken_ = 0;
  Time begin_{};
};

}  // namespace cairn::velodyne
