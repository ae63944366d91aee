// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fusion/matching/book/point_grid.hpp"
#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/matcher.hpp"

namespace cairn::matching {

/// What the book's methods share: they work on the voxels themselves, start at one pose and descend. Their result
/// carries the book's own test of acceptance (3.22, 4.20–4.21) as well as ours. So that a step of the budget has a
/// bounded cost, at most kMostSources voxels of the source (a fixed choice) look for partners among all of the
/// target's, and maps of more than kMostVoxels are refused: the book's largest has 76 thousand.
class VoxelMatcher : public Matcher {
 public:
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const final;

  static constexpr float kGateM = 2;  ///< of the first level's pairs, the protocol's search gate
  static constexpr int kMinPairs = 20;
  static constexpr std::size_t kMostSources = 20'000, kMostVoxels = 500'000;

 protected:
  VoxelMatcher(const MapFeatures& a, const MapFeatures& b);

  /// The method: where it gets to from the prior's mean.
  [[nodiscard]] virtual SE3 descend(const UncertainPose& prior, Budget& budget) const = 0;

  /// Index of the target voxel that is nearest in (x, y, z, √ω_o·p) (3.9, 4.13), or PointGrid::kNone.
  [[nodiscard]] int associate(const Eigen::Vector3f& at, float occupancy, float gate_m, double occupancy_weight) const;
  /// One closed-form step over such pairs; `weighted`: by (1/p_r + 1/p_s)⁻¹ (4.18). The step moves the source as it
  /// lies under `T`; `mean_squared` gets the mean squared distance of the pairs. No step with too few pairs.
  [[nodiscard]] std::optional<SE3> closed_form_step(const SE3& T, float gate_m, double occupancy_weight, bool weighted,
                                                    double& mean_squared) const;

  /// What the judge's evidence, free space included, says for a pose, for ranking.
  [[nodiscard]] double score(const SE3& T_a_b) const { return judge_.score(T_a_b); }

  [[nodiscard]] const std::vector<Voxel>& voxels_a() const { return voxels_a_; }
  [[nodiscard]] const std::vector<Voxel>& voxels_b() const { return voxels_b_; }
  /// Those of b that look for partners.
  [[nodiscard]] const std::vector<Voxel>& sources_b() const { return sources_b_; }
  [[nodiscard]] const PointGrid& points_a() const { return points_a_; }
  [[nodiscard]] double resolution() const { return resolution_; }
  /// H(m) of the target (3.11), bits, kept above zero.
  [[nodiscard]] double entropy_a() const { return entropy_a_; }

 private:
  Judge judge_;
  double resolution_;
  bool too_large_;
  std::vector<Voxel> voxels_a_, voxels_b_, sources_b_;  // none of maps that are too large
  PointGrid points_a_;
  double entropy_a_;
};

[[nodiscard]] std::vector<Eigen::Vector3f> centres_of(const std::vector<Voxel>& voxels);
/// Whether a step is too small to go on: 0.1 mm and 10⁻⁵ rad.
[[nodiscard]] bool negligible(const SE3& step);

}  // namespace cairn::matching
