// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fusion/matching/features/map_voxels.hpp"

namespace cairn::matching {

/// Settings of structural_edges(). The book gives κ and d_T. The others are chosen by hand, not
/// tuned.
struct EdgeOptions {
  /// R_N: of the neighbourhood that gives a voxel's normal, in voxels.
  double normal_radius_cells = 3.5;
  double min_angle_cost = 0.5;  ///< κ (4.4), no unit
  double trace_m = 0.5;         ///< d_T of Alg. 2, m
  int step_deg = 15;            ///< δ of Alg. 2, degrees
  int outlier_neighbours = 8;   ///< k of the statistical outlier removal
};

/// The edges at which two surfaces meet: what the book's first level matches.
struct StructuralEdges {
  std::vector<Voxel> voxels;
  std::vector<Eigen::Vector3f> directions;   ///< τ, unit length, sign arbitrary (4.5)
  std::vector<Eigen::Matrix3f> covariances;  ///< Σ_g = (Σ_p⁻¹ + Σ_τ⁻¹)⁻¹ (4.8), m²
  double quality = 0;  ///< λ_τ = mean λ₃/(λ₁+λ₂+λ₃) (4.14), 1/3…1; 0 without edges
};

/// Candidates that are traced, at most (a fixed sample). A bound on time. The book's rooms have 3
/// to 4 thousand edges.
inline constexpr std::size_t kMostCandidates = 10'000;

/// Unit normals by the spread of the occupied voxels within the radius. Zero with fewer than five
/// of them.
[[nodiscard]] std::vector<Eigen::Vector3f> voxel_normals(std::span<const Voxel> voxels, double radius_cells);

/// Alg. 2 (ch. 4), in four steps:
/// 1. Candidates are voxels whose normals differ from their neighbours' by more than κ on average
///    (4.4).
/// 2. From each, two walks of d_T along the surface in opposite directions, for all directions of
///    the tangent plane. At an edge, two such walks enclose an angle of 80° to 100°.
/// 3. Outliers are removed: mean distance to k neighbours above the mean by one σ.
/// 4. Directions and covariances of what is left (4.5, 4.8, 4.14).
[[nodiscard]] StructuralEdges structural_edges(std::span<const Voxel> voxels, double resolution_m,
                                               const EdgeOptions& options = {});

/// Σ_p = (1/p)·I (4.3) times (d/2)², so that it is in m².
[[nodiscard]] Eigen::Matrix3f voxel_covariance(const Voxel& voxel, double resolution_m);

}  // namespace cairn::matching
