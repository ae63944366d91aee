// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "hal/time.hpp"

namespace cairn::peers {

/// The difference between a peer's clock and this robot's, from hellos and the hellos that answer them (as in NTP,
/// RFC 5905 §8). Of the last sixteen exchanges, the one with the shortest way there and back counts: the others have
/// waited in queues.
class ClockOffset {
 public:
  /// The offset of two clocks, and how far it may be off.
  struct Estimate {
    Duration offset{};  ///< the peer's clock minus this robot's
    Duration bound{};   ///< the largest error of the offset, but for the clocks' drift since `at`
    Time at{};          ///< when it was measured, this robot's clock
  };
  static constexpr std::size_t kSamples = 16;

  /// This robot sent a hello at `sent` and received the answer at `answered`, by its own clock. The peer answered at
  /// `replied`, by its clock, after it had held the hello for `held`. False if the answer came before the question.
  bool add(Time sent, Duration held, Time replied, Time answered) {
    const Duration way = answered - sent - held;
    if (way < Duration::zero() || held < Duration::zero()) return false;
    const Duration offset = (replied - held - sent) / 2 + (replied - answered) / 2;
    samples_[next_++ % kSamples] = {offset, way / 2, answered};
    return true;
  }
  [[nodiscard]] std::optional<Estimate> estimate() const {
    std::optional<Estimate> best;
    for (std::size_t i = 0; i < std::min(next_, kSamples); ++i)
      if (!best || samples_[i].bound < best->bound) best = samples_[i];
    return best;
  }
  /// The longest way there and back of the last sixteen exchanges; nothing before the first.
  [[nodiscard]] std::optional<Duration> longest_way() const {
    std::optional<Duration> longest;
    for (std::size_t i = 0; i < std::min(next_, kSamples); ++i)
      longest = std::max(longest.value_or(Duration::zero()), 2 * samples_[i].bound);
    return longest;
  }

 private:
  std::array<Estimate, kSamples> samples_{};
  std::size_t next_ = 0;
};

}  // namespace cairn::peers
