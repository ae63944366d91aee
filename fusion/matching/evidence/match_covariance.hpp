// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/evidence/evidence.hpp"

namespace cairn::matching {

/// The covariance of T (right perturbation, m and rad): (H M⁻¹ H + Σ₀⁻¹)⁻¹.
/// - H = Σ w J Jᵀ over the surfels that agree, with the weight() of refine(),
/// - M is the covariance of the gradient Σ w J r of the residuals r along the normals,
/// - Σ₀ is the prior's covariance. A direction that no surface fixes keeps its uncertainty.
///
/// Residuals are not independent. Neighbouring surfels share voxels, and a stretch of wall is off
/// by one common part of a voxel in each map. So r = b + ε, with one b for each stretch and ε of
/// variance s_ε²/w: M = s_ε² k Σ w J Jᵀ + s_b² Σ (ΣwJ)(ΣwJ)ᵀ over stretches. Both variances are
/// taken from the residuals. tests/bench/matching_covariance compares the result with the errors.
[[nodiscard]] Matrix6 covariance(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source,
                                 const SE3& T_target_source, const Matrix6& prior_covariance,
                                 const EvidenceConfig& config = {});

}  // namespace cairn::matching
