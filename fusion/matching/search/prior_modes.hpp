// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fusion/matching/features/map_features.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Where, within a prior's window, two maps' structure lies best on each other: what makes the start irrelevant.
class PriorModes {
 public:
  PriorModes(const MapFeatures& a, const MapFeatures& b);

  /// Poses T_a_b within three standard deviations of the prior (at least 0.8 m and 4°, at most 20 m), best first, by
  /// correlation of the coarse structure; see search(). At least one.
  [[nodiscard]] std::vector<SE3> near(const UncertainPose& prior) const;

 private:
  std::vector<Eigen::Vector3f> structure_a_, structure_b_;
  float cell_m_;
};

/// Whether a pose that was found from one of these is still where the prior has it, by a small margin: the next door of
/// a corridor often fits as well, and refinement goes there.
[[nodiscard]] bool within(const UncertainPose& prior, const SE3& T_a_b);

}  // namespace cairn::matching
