// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/book/structural_edges.hpp"
#include "fusion/matching/book/voxel_matcher.hpp"

namespace cairn::matching {

/// Probabilistic map matching (ch. 4), in two levels:
/// 1. Structural edges, paired in seven dimensions (x, y, z, √ω_o·p, √ω_τ·τ) (4.12) and weighted by
///    their covariances (4.17).
/// 2. All voxels, paired in four dimensions (4.13) and weighted by occupancy (4.18).
///
/// ω_o = MSE/H and ω_τ = MSE·λ_τ (4.15, 4.16, k₁ = k₂ = 1). Edge directions have no sign: the nearer
/// of ±τ counts.
class Pmm : public VoxelMatcher {
 public:
  Pmm(const MapFeatures& a, const MapFeatures& b) : Pmm(a, b, true) {}

 protected:
  /// Without `probabilistic` edges are points: paired in three dimensions, all with the same
  /// weight.
  Pmm(const MapFeatures& a, const MapFeatures& b, bool probabilistic);
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
  /// The first level: at most so many iterations.
  [[nodiscard]] SE3 match_edges(SE3 T, int iterations, Budget& budget) const;

 private:
  struct Weights {
    double occupancy = 0, direction = 0;
  };
  [[nodiscard]] std::optional<SE3> edge_step(const SE3& T, const Weights& weights, double& mean_squared) const;

  bool probabilistic_;
  StructuralEdges edges_a_, edges_b_;
  PointGrid edge_points_a_;
};

/// The first level of PMM alone.
class PmmLevel1 : public Pmm {
 public:
  PmmLevel1(const MapFeatures& a, const MapFeatures& b) : PmmLevel1(a, b, true) {}

 protected:
  using Pmm::Pmm;

 private:
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
};

/// ICP between the edges, point to point: the book's comparison for its first level (section
/// 4.6.2).
class EdgeIcp final : public PmmLevel1 {
 public:
  EdgeIcp(const MapFeatures& a, const MapFeatures& b) : PmmLevel1(a, b, false) {}
};

}  // namespace cairn::matching
