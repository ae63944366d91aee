// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "hal/time.hpp"

namespace cairn::peer_link {

/// Traffic stays below `bytes_per_second` in every one-second window. The rate is shared: a burst may gather in a pause
/// (an eighth of the rate, and two datagrams at least), and the rest is refilled within a second.
class TokenBucket {
 public:
  explicit TokenBucket(double bytes_per_second)
      : burst_(std::min(bytes_per_second / 2, std::max(kTwoDatagrams, bytes_per_second / 8))),
        refill_(bytes_per_second - burst_),
        level_(burst_) {}

  /// Whether take() would let so many bytes through now.
  [[nodiscard]] bool has(std::size_t bytes, Time now, bool urgent = false) {
    if (now > last_) {
      level_ = std::min(burst_, level_ + refill_ * to_seconds(now - last_));
      last_ = now;
    }
    return static_cast<double>(bytes) <= level_ - (urgent ? 0 : burst_ / 3);
  }
  /// Whether `bytes` may go now. If so, they are counted. A third of the burst is kept for urgent bytes.
  [[nodiscard]] bool take(std::size_t bytes, Time now, bool urgent = false) {
    if (!has(bytes, now, urgent)) return false;
    level_ -= static_cast<double>(bytes);
    return true;
  }

 private:
  static constexpr double kTwoDatagrams = 2800;  // bytes, with all headers

  double burst_, refill_, level_;
  Time last_{};
};

}  // namespace cairn::peer_link
