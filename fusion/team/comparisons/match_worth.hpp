// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "fusion/team/comparisons/match_outlook.hpp"
#include "hal/time.hpp"

namespace cairn::team {

/// When the comparison of two maps is worth its time.
struct MatchWorthConfig {
  Duration period = std::chrono::seconds(5);  ///< between two comparisons of one pair, at least
  double growth = 1.15;                       ///< factor by which a map, or what both see, must grow
  /// A comparison without growth waits so long, if anything has changed. The wait doubles each time
  /// that a comparison changes nothing, up to `longest_retry`.
  Duration first_retry = std::chrono::seconds(20);
  Duration longest_retry = std::chrono::minutes(20);
  int rest = 4;  ///< a pair waits at least so many times as long as its last comparison took
};

/// When comparing the maps of one pair is worth the time. Pure: a function of the calls.
/// - Maps that have grown are compared. For a merged pair, only growth of what both see counts.
/// - Without growth, failed comparisons are retried with growing delay.
/// - The same maps are never compared twice.
class MatchWorth {
 public:
  MatchWorth() = default;
  explicit MatchWorth(const MatchWorthConfig& config) : config_(config) {}

  /// True while even growth would not make a comparison due.
  [[nodiscard]] bool rests(Time now) const { return began_ != Time::min() && now < began_ + pause(); }
  /// What a comparison is worth now, per second that it takes. 0: wait.
  [[nodiscard]] double of(const MatchOutlook& outlook, Time now) const;

  void begin(const MatchOutlook& outlook, Time now);
  /// After begin(). `fruitful`: the comparison changed what is believed of the pair.
  void end(bool fruitful, Time now);
  /// When the last comparison began; Time::min() before the first.
  [[nodiscard]] Time last() const { return began_; }

 private:
  [[nodiscard]] bool grown(const MatchOutlook& outlook) const;
  [[nodiscard]] Duration pause() const { return std::max(config_.period, config_.rest * took_); }
  [[nodiscard]] Duration retry() const;

  MatchWorthConfig config_;
  Time began_ = Time::min();
  Duration took_{};
  int in_vain_ = 0;
  MatchOutlook then_;
};

}  // namespace cairn::team
