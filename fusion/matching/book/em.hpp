// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/book/voxel_matcher.hpp"
#include "fusion/matching/search/prior_modes.hpp"

namespace cairn::matching {

/// Expectation–maximisation for maps of different sensors (ch. 5). Each voxel of the sparse map is paired with as many
/// of the dense one as their local densities say (Alg. 3), softly: ω_ij = exp(−d²/2σ²), normalised (E-step), where a
/// partner at 2σ counts as much as having none: maps that overlap in part would otherwise be dragged onto each other.
/// The M-step is Gauss–Newton on the weighted distances with the prior p(T) = N(T₀, Σ₀) (5.4, 5.8). EM climbs to the
/// nearest maximum of the posterior, and a prior of metres holds many: each mode of the maps' correlation is climbed a
/// little with few voxels, the best of them, free space considered, to the top. σ shrinks to a voxel. Density is the
/// number of occupied neighbours within five voxels, of the dense map its mean (the book takes the nearest voxel's,
/// which means little while the pose is unknown); the sparser map gives the voxels.
class Em final : public VoxelMatcher {
 public:
  Em(const MapFeatures& a, const MapFeatures& b);

  /// Mean number of pairs of a voxel of the sparse map: what falls as it fills (book: 3.57 → 2.15).
  [[nodiscard]] double mean_correspondences() const;

 private:
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
  /// One E- and M-step with every `stride`-th voxel of the sparse map.
  [[nodiscard]] std::optional<SE3> step(const SE3& T, const UncertainPose& prior, double sigma,
                                        std::size_t stride) const;
  [[nodiscard]] SE3 climb(SE3 T, const UncertainPose& prior, Budget& budget) const;

  PriorModes modes_;
  bool sparse_is_b_;
  PointGrid points_b_;
  std::vector<Eigen::Vector3f> sparse_;  // those of the sparse map's voxels that look for partners
  std::vector<int> correspondences_;     // c_i of each, at least 1
};

}  // namespace cairn::matching
