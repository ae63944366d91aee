// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/book/voxel_densities.hpp"
#include "fusion/matching/book/voxel_matcher.hpp"
#include "fusion/matching/search/prior_modes.hpp"

namespace cairn::matching {

/// Expectation–maximisation for maps of different sensors (ch. 5), Cairn's own. EmBook is the book's.
/// - Each voxel of the sparse map is paired with as many of the dense one as their local densities
///   say (Alg. 3). That of the dense map is its mean; the book takes the nearest voxel's, which
///   means little while the pose is unknown.
/// - E-step: weights ω_ij = exp(−d²/2σ²), normalised. Having no partner counts as much as a partner
///   at 2σ. Otherwise maps that overlap in part are dragged onto each other.
/// - M-step: Gauss–Newton on the weighted distances, with the prior p(T) = N(T₀, Σ₀) (5.4, 5.8).
///
/// EM climbs to the nearest maximum of the posterior, and a prior of metres holds many. So each
/// mode of PriorModes is climbed a little with few voxels. The best one by score() is climbed to
/// the top, while σ shrinks to a voxel.
class Em final : public VoxelMatcher {
 public:
  Em(const MapFeatures& a, const MapFeatures& b);

  /// Mean number of pairs of a voxel of the sparse map. It falls as that map fills (book: 3.57 to
  /// 2.15).
  [[nodiscard]] double mean_correspondences() const;

 private:
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
  /// One E- and M-step with every `stride`-th voxel of the sparse map.
  [[nodiscard]] std::optional<SE3> step(const SE3& T, const UncertainPose& prior, double sigma,
                                        std::size_t stride) const;
  [[nodiscard]] SE3 climb(SE3 T, const UncertainPose& prior, Budget& budget) const;

  PriorModes modes_;
  PointGrid points_b_;
  SparseMap sparse_;
  std::vector<int> correspondences_;  // c_i of each of its voxels, at least 1
};

}  // namespace cairn::matching
