// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fusion/matching/belief/pending.hpp"
#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/matcher_config.hpp"
#include "hal/budget.hpp"

namespace cairn::matching {

/// Settings of GrowingMatch.
struct GrowingMatchConfig {
  MatcherConfig matcher;
  BeliefConfig belief;
  /// The maps are searched again when one of them has so many times the surfels of the last search.
  /// Chosen by hand, not tuned.
  double growth = 1.2;
  /// Fine surfels that each map must have for a comparison. Chosen by hand, not tuned.
  std::size_t least_surfels = 1500;
  std::size_t most_found = 4;  ///< new places of a search; chosen by hand, not tuned
  std::size_t most_near = 2;   ///< new places of a search near a guess; chosen by hand, not tuned
};

/// Follows two maps while they grow. Each update weighs the known places again, which is cheap. The
/// maps are searched again when one of them has grown by a fifth. They are searched as well before a
/// place is accepted, because a rival may have appeared since.
class GrowingMatch {
 public:
  explicit GrowingMatch(const GrowingMatchConfig& config = {})
      : config_(config), hypotheses_(config.belief, config.matcher.acceptance) {}

  /// To be called when the maps have grown. It waits while a map holds too little. A guess of T_a_b
  /// (see guess.hpp) is searched first. The search everywhere follows all the same, because the
  /// guess may be wrong. Places elsewhere than a `firm` guess are never believed.
  void update(const MapFeatures& a, const MapFeatures& b, Budget& budget,
              const std::optional<UncertainPose>& guess = {}, bool firm = false);

  [[nodiscard]] const PendingHypotheses& hypotheses() const { return hypotheses_; }
  /// T_a_b of a likely place that a firm guess denied in the last update.
  [[nodiscard]] const std::optional<SE3>& denied() const { return denied_; }

 private:
  /// Whether one of the maps has grown enough since the last search.
  [[nodiscard]] bool due(const MapFeatures& a, const MapFeatures& b) const;
  /// Whether these looks would make a place accepted.
  [[nodiscard]] bool would_accept(const std::vector<Look>& looks, const std::optional<UncertainPose>& guess) const;

  void deny(std::vector<Look>& looks, const UncertainPose& firm);

  GrowingMatchConfig config_;
  std::optional<SE3> denied_;
  PendingHypotheses hypotheses_;
  std::size_t searched_a_ = 0, searched_b_ = 0;  // surfels at the last search
};

}  // namespace cairn::matching
