// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>

#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/mapping/tree/map_tile.hpp"

namespace cairn {

struct MatchWorthConfig {
  Duration period = std::chrono::seconds(5);          ///< between two comparisons of one pair, at least
  double growth = 1.15;                               ///< of a map, or of what both see, that makes a comparison due
  Duration first_retry = std::chrono::seconds(20);    ///< without growth, where anything has changed; twice as long
  Duration longest_retry = std::chrono::minutes(20);  ///< each time that it changed nothing, up to this
  int rest = 4;  ///< times as long as the last comparison took, the pair waits at least
};

/// What is known of two maps before they are compared.
struct MatchOutlook {
  std::size_t own_tiles = 0, peer_tiles = 0;  ///< with something occupied
  std::optional<std::size_t> common_tiles;    ///< that both have seen, by the likeliest pose; nothing: none is likely
  std::uint64_t own_version = 0, peer_version = 0;  ///< of all that was said: the same, the same maps
  bool merged = false;                              ///< a comparison can only confirm it, refine it, or take it back
};

/// About how many tiles of b meet tiles of a, by where b lies in a: by a sample of b's, where they are many.
[[nodiscard]] std::size_t tiles_of_both(const std::set<TileKey>& a, const std::set<TileKey>& b, const SE3& T_a_b,
                                        double resolution_m);

/// When comparing the maps of one pair is worth the time. Maps that have grown may say something new: what both
/// see, where a pose is likely, and all of them before it is believed. Without growth little is to be expected, but not
/// nothing: what was withdrawn or was pending is tried again after a while, and each time in vain the while is longer.
/// The same maps are never compared twice. Pure: a function of the calls.
class MatchWorth {
 public:
  MatchWorth() = default;
  explicit MatchWorth(const MatchWorthConfig& config) : config_(config) {}

  /// Whether no growth would make a comparison due yet.
  [[nodiscard]] bool rests(Time now) const { return began_ != Time::min() && now < began_ + pause(); }
  /// What a comparison is worth now, per second that it will take; 0: nothing, wait.
  [[nodiscard]] double of(const MatchOutlook& outlook, Time now) const;

  void begin(const MatchOutlook& outlook, Time now);
  /// `fruitful`: what is believed or pending of the pair has changed.
  void end(bool fruitful, Time now);
  /// When the last one began; Time::min(): none has.
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

}  // namespace cairn
