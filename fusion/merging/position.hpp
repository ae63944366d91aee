// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "hal/se3.hpp"

namespace cairn::merging {

/// Where something is, m, and how well that is known, m².
struct Position {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// A voxel's own uncertainty: Σ_p = (1/p)·I (4.3) of half an edge, so that it is in m².
[[nodiscard]] Eigen::Matrix3d voxel_covariance(double occupancy, double edge_m);

/// A position seen in b, in frame a (5.14): Σ' = F Σ_T Fᵀ + R Σ_x Rᵀ, F = ∂(T·exp(ξ) x)/∂ξ = R (I, −[x]×).
[[nodiscard]] Position moved(const UncertainPose& T_a_b, const Position& in_b);

/// The product of two Gaussians (5.15–5.17): Σ = (Σ₁⁻¹ + Σ₂⁻¹)⁻¹, μ = Σ (Σ₁⁻¹ μ₁ + Σ₂⁻¹ μ₂). Both covariances are
/// positive definite; the product's trace is below either's.
[[nodiscard]] Position product(const Position& first, const Position& second);

}  // namespace cairn::merging
