// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/matcher.hpp"

namespace cairn::matching {

/// All six degrees of freedom: neither map's gravity need be known, as with a camera without an inertial unit or a
/// robot that started on its side. Both maps are levelled in each way that what they hold suggests (levellings()), the
/// second one upside down, too, and each pair is matched as GlobalMatcher does, until one is all but certain; else the
/// best of them, by score, is the result. It is in the maps' own frames. Up to eighteen times GlobalMatcher's cost.
/// Levelling is by nearest voxels, so that a pose is a little less exact. Never believes a guess.
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
