// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "hal/time.hpp"

namespace cairn::peers {

/// Difference of a peer's clock to one's own, from hellos that were answered by hellos (as NTP does, RFC 5905 §8). The
/// exchange with the shortest way there and back of the last sixteen counts, since waiting in queues is what spoils
/// them.
class ClockOffset {
 public:
  struct Estimate {
    Duration offset{};  ///< the peer's clock less one's own
    Duration bound{};   ///< the offset is at most so much off, plus what the clocks drift apart
    Time at{};          ///< own clock
  };
  static constexpr std::size_t kSamples = 16;

  /// `sent` and `answered` by one's own clock, `received` … `replied` by the peer's, less its residence: the peer says
  /// how long it waited. False for what cannot be: an answer before the question.
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
  /// The longest way there and back of the last sixteen exchanges.
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
