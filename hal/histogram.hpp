// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/relaxed_counter.hpp"
#include "hal/time.hpp"

namespace cairn {

/// Durations in fixed log-linear buckets: 128 per power of two, so a percentile is off by 0.8 % at most. Never
/// allocates. One thread records; any thread may read meanwhile, and sees counts that are a moment apart at most.
class Histogram {
 public:
  /// Counts one duration. Negative ones count as zero.
  void record(Duration d);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] Duration max() const { return Duration{static_cast<std::int64_t>(max_ns_.get())}; }
  [[nodiscard]] Duration mean() const;
  /// The smallest value that at least `share` (0…1) of the records do not exceed; zero when there are none.
  [[nodiscard]] Duration percentile(double share) const;

  /// One bucket, for plots: [lower, upper) and its count.
  struct Bucket {
    Duration lower{}, upper{};
    std::uint64_t count = 0;
  };
  static constexpr std::size_t kBuckets = 128 * 30;
  /// 0 <= index < kBuckets.
  [[nodiscard]] Bucket bucket(std::size_t index) const;

 private:
  std::array<RelaxedCounter, kBuckets> counts_{};
  RelaxedCounter count_, sum_ns_, max_ns_;
};

}  // namespace cairn
