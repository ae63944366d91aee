// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "hal/time.hpp"

namespace cairn::peers {

/// Never lets more than `rate` bytes through in any second: what has gathered is at most half of that, and it refills
/// at half of it, so that a burst after a pause and the refill of the same second are the rate together.
class TokenBucket {
 public:
  explicit TokenBucket(double bytes_per_second) : rate_(bytes_per_second), level_(bytes_per_second / 2) {}

  /// Whether `bytes` may go now; they are counted then.
  [[nodiscard]] bool take(std::size_t bytes, Time now) {
    if (now > last_) {
      level_ = std::min(rate_ / 2, level_ + rate_ / 2 * to_seconds(now - last_));
      last_ = now;
    }
    if (static_cast<double>(bytes) > level_) return false;
    level_ -= static_cast<double>(bytes);
    return true;
  }

 private:
  double rate_, level_;
  Time last_{};
};

}  // namespace cairn::peers
