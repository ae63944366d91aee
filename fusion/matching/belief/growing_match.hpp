// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/matching/belief/pending.hpp"
#include "fusion/matching/features/map_features.hpp"
#include "hal/budget.hpp"

namespace cairn::matching {

/// Keeps an eye on two maps that grow: what is pending is looked at again each time, which is cheap, and the maps are
/// searched anew whenever one of them has grown by a fifth.
class GrowingMatch {
 public:
  /// To be called when the maps have grown. A map with too little in it makes it wait. A guess of T_a_b (see guess.hpp)
  /// is searched first, and then everywhere as without one: it may be wrong.
  void update(const MapFeatures& a, const MapFeatures& b, Budget& budget,
              const std::optional<UncertainPose>& guess = {});

  [[nodiscard]] const PendingHypotheses& hypotheses() const { return hypotheses_; }

 private:
  [[nodiscard]] bool due(const MapFeatures& a, const MapFeatures& b);

  PendingHypotheses hypotheses_;
  std::size_t searched_a_ = 0, searched_b_ = 0;  // surfels at the last search
};

}  // namespace cairn::matching
