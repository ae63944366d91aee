// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "hal/time.hpp"

namespace cairn::peers {

/// How many bytes may be sent now. It grows with time, up to what one second grants.
class ByteBudget {
 public:
  explicit ByteBudget(std::size_t bytes_per_second) : per_second_(static_cast<double>(bytes_per_second)) {}

  /// Grants the bytes of the time since the last call. The first call grants none.
  void refill(Time now) {
    if (last_ != Time::min()) left_ = std::min(per_second_, left_ + per_second_ * to_seconds(now - last_));
    last_ = now;
  }
  /// Status messages are sent in any case, so the budget may become negative.
  void spend(double bytes) { left_ -= bytes; }
  [[nodiscard]] double left() const { return left_; }
  [[nodiscard]] double per_second() const { return per_second_; }

 private:
  double per_second_;
  double left_ = 0;
  Time last_ = Time::min();
};

}  // namespace cairn::peers
