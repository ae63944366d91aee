// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fusion/matching/features/nearest_grid.hpp"
#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

struct RefineOptions {
  float gate_m = 1.2F;       ///< largest distance of a pair in the first iteration,
  float last_gate_m = 0.5F;  ///< which shrinks by `gate_decay` each time down to this
  float gate_decay = 0.75F;
  int max_iterations = 12;
  float robust_m = 0;                     ///< pairs this far apart along their normals count a quarter; 0: all alike
  double stop_m = 1e-4, stop_rad = 1e-5;  ///< a smaller step, once the gate has shrunk, ends it
};

struct Refinement {
  SE3 T_target_source;
  int iterations = 0;
  int pairs = 0;  ///< of the last iteration
};

/// Normal equations of one iteration; the parameters are a right perturbation of T, (translation, rotation).
struct NormalEquations {
  Matrix6 H = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
  double cost = 0;
  int pairs = 0;
};
/// Whether a pair is of level ground or a ceiling. Of the pairs that are, the height alone counts: the voxels of
/// sloping ground are terraces, whose edges would hold fast in the wrong place.
[[nodiscard]] bool level(const Surfel& target, const Surfel& source);
/// What a pair counts along its normals; two upright planes count 1. Clutter, which has no plane, errs by three times
/// as much. Level ground counts the less the more its planes lean, as that is where a floor changes from one layer of
/// voxels to the next.
[[nodiscard]] float weight(const Surfel& target, const Surfel& source);
/// Σ eᵀ (Σ_t + R Σ_s Rᵀ)⁻¹ e over the pairs within the gate, e = T x_s − x_t less off_the_face(), with the covariance
/// of a surfel thin along its normal (4.17, with R on the side that makes both covariances speak of the target's
/// frame), times weight(). Pairs that were seen from opposite sides are left out.
[[nodiscard]] NormalEquations plane_to_plane(std::span<const Surfel> target, const NearestGrid& nearest,
                                             std::span<const Surfel> source, const SE3& T, float gate_m,
                                             float robust_m = 0);

/// Gauss–Newton on plane_to_plane(). Stops early when fewer than 20 pairs are left or the budget is spent.
[[nodiscard]] Refinement refine(std::span<const Surfel> target, const NearestGrid& nearest,
                                std::span<const Surfel> source, const SE3& initial, const RefineOptions& options,
                                Budget& budget);

}  // namespace cairn::matching
