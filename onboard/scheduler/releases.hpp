// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/time.hpp"

namespace cairn::scheduler {

/// The instants at which one task is released. Pure arithmetic, so they do not drift.
struct Releases {
  Time first{};
  Duration period{1};

  [[nodiscard]] Time at(std::uint64_t k) const { return first + static_cast<std::int64_t>(k) * period; }
  /// The first release that is not before `t`.
  [[nodiscard]] std::uint64_t not_before(Time t) const {
    if (t <= first) return 0;
    return static_cast<std::uint64_t>((t - first + period - Duration{1}) / period);
  }
  /// The next release after tick k, which ended at `end`. Releases that have passed are skipped: two ticks never run
  /// back to back, and the phase is kept.
  [[nodiscard]] std::uint64_t after(std::uint64_t k, Time end) const {
    const std::uint64_t next = not_before(end);
    return next > k ? next : k + 1;
  }
};

}  // namespace cairn::scheduler
