// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "hal/time.hpp"

namespace cairn::safety {

/// Whether more than half of what a source sent within the last second was refused (Fault::kLidarRejected). Pure; the
/// second is ten parts long, so that the answer is at most a tenth late.
class RejectionWatch {
 public:
  /// The source's counters so far; a `now` before the last one counts as the last one.
  bool step(Time now, std::uint64_t accepted, std::uint64_t refused) {
    const std::int64_t part = std::max(part_, now.time_since_epoch() / kPart);
    for (std::int64_t p = std::max(part_ + 1, part - kParts + 1); p <= part; ++p) parts_[index(p)] = {};
    part_ = part;
    parts_[index(part)].accepted += accepted - accepted_;
    parts_[index(part)].refused += refused - refused_;
    accepted_ = accepted;
    refused_ = refused;
    Part sum;
    for (const Part& p : parts_) sum.accepted += p.accepted, sum.refused += p.refused;
    return sum.refused > sum.accepted;
  }

 private:
  static constexpr Duration kPart = std::chrono::milliseconds(100);
  static constexpr std::int64_t kParts = 10;
  struct Part {
    std::uint64_t accepted = 0, refused = 0;
  };
  static std::size_t index(std::int64_t part) { return static_cast<std::size_t>((part % kParts + kParts) % kParts); }

  std::array<Part, kParts> parts_{};
  std::int64_t part_ = -kParts;
  std::uint64_t accepted_ = 0, refused_ = 0;
};

}  // namespace cairn::safety
