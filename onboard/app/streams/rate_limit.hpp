// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/time.hpp"

namespace cairn::app {

/// Lets through what comes too often, as seldom as asked. The mean rate is kept, whatever the grid of the calls.
class RateLimit {
 public:
  /// 0: everything goes through.
  explicit RateLimit(double rate_hz = 0) : period_(rate_hz > 0 ? from_seconds(1 / rate_hz) : Duration{}) {}

  /// Whether it is time again.
  [[nodiscard]] bool due(Time now) {
    if (now < next_) return false;
    next_ = next_ + period_ > now ? next_ + period_ : now + period_;
    return true;
  }

 private:
  Duration period_;
  Time next_{};
};

}  // namespace cairn::app
