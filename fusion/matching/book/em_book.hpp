// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/book/voxel_densities.hpp"
#include "fusion/matching/book/voxel_matcher.hpp"

namespace cairn::matching {

/// Probabilistic map matching by expectation–maximisation, as the book prints it (Alg. 3). `Em` is Cairn's own.
/// - Each voxel i of the sparse map looks for c_i voxels of the dense one, the nearest. c_i is the density of the
///   nearest dense voxel by its own, rounded. Maps of like densities: one each.
/// - E-step: ω_ij = exp(−‖T x_i − x_j‖²), in m, with no σ and not normalised.
/// - M-step: all pairs, weighted, in closed form (5.8 leaves the choice).
///
/// It descends from one start, with no prior, and drags maps that overlap in part onto each other. What the book leaves
/// out is as in the other methods here: the radius of a density (SparseMap), the gate (kGate_m), and how often it is
/// repeated.
class EmBook final : public VoxelMatcher {
 public:
  EmBook(const MapFeatures& a, const MapFeatures& b);

 private:
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
  /// One E- and M-step: the motion of b in a's frame, to be put before T. `densities`: of the dense map, those that
  /// were asked for; else −1.
  [[nodiscard]] std::optional<SE3> step(const SE3& T, std::vector<int>& densities) const;

  PointGrid points_b_;
  SparseMap sparse_;
};

}  // namespace cairn::matching
