// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/evidence/evidence.hpp"

namespace cairn::matching {

/// The covariance of T (right perturbation, m and rad) that the residuals along the normals of agreeing surfels give,
/// with the prior's covariance Σ₀: (H M⁻¹ H + Σ₀⁻¹)⁻¹, H = Σ w J Jᵀ and M the covariance of the gradient Σ w J r, with
/// weight() of refine(). Residuals are not independent: neighbouring surfels share voxels, and a stretch of wall lies
/// off by one common part of a voxel in each map. So r = b + ε with one b for each stretch and ε of variance s_ε²/w, M
/// = s_ε² k Σ w J Jᵀ + s_b² Σ (ΣwJ)(ΣwJ)ᵀ over stretches, both variances as the residuals show them. A direction that
/// no surface fixes keeps the prior's uncertainty.
[[nodiscard]] Matrix6 covariance(const Party& target, const NearestGrid& nearest, const Party& source,
                                 const SE3& T_target_source, const Matrix6& prior_covariance);

}  // namespace cairn::matching
