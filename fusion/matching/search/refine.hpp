// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fusion/matching/features/nearest_grid.hpp"
#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Settings of one refinement. The defaults are a prototype's for cells of 0.4 m.
struct RefineOptions {
  float gate_m = 1.2F;       ///< largest distance of a pair in the first iteration, m
  float last_gate_m = 0.5F;  ///< the gate shrinks to this, m
  float gate_decay = 0.75F;  ///< the gate shrinks by this factor in each iteration
  int max_iterations = 12;   ///< each is a step of the budget
  /// Pairs this far apart along their normals count 1/4, m; 0: all count 1.
  float robust_m = 0;
  double stop_m = 1e-4, stop_rad = 1e-5;  ///< ends at a smaller step, once the gate has shrunk
  int min_pairs = 20;                     ///< stops with fewer; chosen by hand, not tuned
};

/// The result of a refinement.
struct Refinement {
  SE3 T_target_source;  ///< takes a point of the source to the target
  int iterations = 0;
  int pairs = 0;  ///< of the last iteration
};

/// Normal equations of one iteration. The parameters are a right perturbation of T: translation
/// (m), then rotation (rad).
struct NormalEquations {
  Matrix6 H = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
  double cost = 0;
  int pairs = 0;
};
/// Whether a pair is of level ground or of a ceiling. Only the height of such pairs counts. The
/// voxels of sloping ground are terraces, whose edges would hold the pose in the wrong place.
[[nodiscard]] bool level(const Surfel& target, const Surfel& source);
/// Weight of a pair along its normals. Two upright planes have 1. Clutter has no plane and counts
/// less. Level ground counts less the more its planes lean, because a floor leans where it changes
/// from one layer of voxels to the next.
[[nodiscard]] float weight(const Surfel& target, const Surfel& source);
/// The cost Σ w eᵀ (Σ_t + R Σ_s Rᵀ)⁻¹ e over the pairs within the gate. e = T x_s − x_t less
/// off_the_face(), and w is weight(). A surfel's covariance is thin along its normal (4.17). The
/// book has R on the other side; here both covariances are in the target's frame. Pairs that were
/// seen from opposite sides are left out. `robust_m`: see RefineOptions.
[[nodiscard]] NormalEquations plane_to_plane(std::span<const Surfel> target, const NearestGrid& nearest,
                                             std::span<const Surfel> source, const SE3& T, float gate_m,
                                             float robust_m = 0);

/// Gauss–Newton on plane_to_plane(). Stops early when too few pairs are left or the budget is
/// spent.
[[nodiscard]] Refinement refine(std::span<const Surfel> target, const NearestGrid& nearest,
                                std::span<const Surfel> source, const SE3& initial, const RefineOptions& options,
                                Budget& budget);

}  // namespace cairn::matching
