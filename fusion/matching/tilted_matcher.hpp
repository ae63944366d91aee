// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/matcher.hpp"

namespace cairn::matching {

/// Matches two maps whose gravity is not known, in all six degrees of freedom. Examples are a
/// camera without an inertial unit, and a robot that started on its side. Both maps are turned
/// upright in each way that their surfaces suggest (levellings()), and b upside down, too. Each
/// pair is matched by GlobalMatcher, until one is probably right. Otherwise the result with the
/// best score is taken. The result is in the maps' own frames. Takes up to 18 times GlobalMatcher's
/// time. Maps are turned voxel by voxel, so a pose is a little less exact. It does not use a guess.
class TiltedMatcher final : public Matcher {
 public:
  /// `a` and `b` must outlive the matcher.
  TiltedMatcher(const MapFeatures& a, const MapFeatures& b) : a_(a), b_(b) {}
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const override;

 private:
  const MapFeatures& a_;
  const MapFeatures& b_;
};

}  // namespace cairn::matching
