// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/time.hpp"

namespace cairn::scheduler {

/// The instants at which one task is released. Pure arithmetic: no drift, whatever happens between them.
struct Releases {
  Time first{};
  Duration period{1};

  [[nodiscard]] Time at(std::uint64_t k) const { return first + static_cast<std::int64_t>(k) * period; }
  /// The first release that is not before `t`.
  [[nodiscard]] std::uint64_t not_before(Time t) const {
    if (t <= first) return 0;
    return static_cast<std::uint64_t>((t - first + period - Duration{1}) / period);
  }
  /// After tick k ended at `end`: the next release that is still to come. What was passed is skipped, so that two ticks
  /// never run back to back and the phase is kept.
  [[nodiscard]] std::uint64_t after(std::uint64_t k, Time end) const {
    const std::uint64_t next = not_before(end);
    return next > k ? next : k + 1;
  }
};

}  // namespace cairn::scheduler
