// SPDX-License-Identifier: Apache-2.0
#include "hal/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cairn {
namespace {

// Values below 2^8 ns have a bucket each; above, each power of two is split into 128.
constexpr unsigned kSubBits = 7;

std::size_t index_of(std::uint64_t ns) {
  if (ns < (2U << kSubBits)) return ns;
  const unsigned shift = static_cast<unsigned>(std::bit_width(ns)) - kSubBits - 1;
  return (static_cast<std::size_t>(shift) << kSubBits) + (ns >> shift);
}

std::uint64_t lower_of(std::size_t index) {
  if (index < (2U << kSubBits)) return index;
  const std::size_t shift = (index >> kSubBits) - 1;
  return ((index & ((1U << kSubBits) - 1)) | (1U << kSubBits)) << shift;
}

Duration from_ns(std::uint64_t ns) { return Duration{static_cast<std::int64_t>(ns)}; }

}  // namespace

void Histogram::record(Duration d) {
  const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, d.count()));
  ++counts_[std::min(index_of(ns), kBuckets - 1)];
  ++count_;
  sum_ns_ += ns;
  if (ns > max_ns_) max_ns_ = ns;
}

Duration Histogram::mean() const { return count_ == 0 ? Duration{} : from_ns(sum_ns_ / count_); }

Duration Histogram::percentile(double share) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_.get())));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kBuckets && count_ != 0; ++i) {
    seen += counts_[i];
    if (seen >= std::max<std::uint64_t>(1, wanted)) return std::min(max(), bucket(i).upper - Duration{1});
  }
  return max();
}

Histogram::Bucket Histogram::bucket(std::size_t index) const {
  return {from_ns(lower_of(index)), from_ns(lower_of(index + 1)), counts_[index]};
}

}  // namespace cairn
