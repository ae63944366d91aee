// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/time.hpp"

namespace cairn {

/// Durations in fixed log-linear buckets: 128 per power of two, so a percentile is off by 0.8 % at most. Never
/// allocates.
class Histogram {
 public:
  void record(Duration d);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] Duration max() const { return max_; }
  [[nodiscard]] Duration mean() const;
  /// The smallest value that at least `share` (0…1) of the records do not exceed; zero when there are none.
  [[nodiscard]] Duration percentile(double share) const;

  /// One bucket, for plots: [lower, upper) and its count.
  struct Bucket {
    Duration lower{}, upper{};
    std::uint64_t count = 0;
  };
  static constexpr std::size_t kBuckets = 128 * 30;
  [[nodiscard]] Bucket bucket(std::size_t index) const;

 private:
  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  Duration sum_{}, max_{};
};

}  // namespace cairn
