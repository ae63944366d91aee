// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fusion/matching/book/point_grid.hpp"
#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/matcher.hpp"

namespace cairn::matching {

/// The base of the book's methods. They work on the voxels themselves, start at one pose and
/// descend. Their result has the book's test of acceptance (3.22, 4.20–4.21) as well as ours.
class VoxelMatcher : public Matcher {
 public:
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const final;

  /// Of the first level's pairs: the search gate (section 4.6.3).
  static constexpr float kGate_m = 2;
  /// Of ICP and EM, at most: the protocol's (section 4.6.3).
  static constexpr int kIterations = 30;
  /// A step needs so many. Chosen by hand, not tuned.
  static constexpr int kMinPairs = 20;
  static constexpr double kGridCell_voxels = 4;  ///< edge of a cell of PointGrid. For time only
  /// Voxels of the source that look for partners, at most (a fixed sample). A bound on the cost of
  /// a step.
  static constexpr std::size_t kMostSources = 20'000;
  /// Voxels of a map, at most; a larger map is refused. A bound on memory. The book's largest has
  /// 76 000.
  static constexpr std::size_t kMostVoxels = 500'000;
  /// On the diagonal of H: keeps directions without pairs invertible.
  static constexpr double kDamping = 1e-6;
  static constexpr double kLeastEntropy_bits = 1e-3;  ///< keeps ω_o (3.16) finite

 protected:
  VoxelMatcher(const MapFeatures& a, const MapFeatures& b);

  /// The method: the pose at which it ends, from the prior's mean.
  [[nodiscard]] virtual SE3 descend(const UncertainPose& prior, Budget& budget) const = 0;

  /// Index of the target voxel that is nearest in (x, y, z, √ω_o·p) (3.9, 4.13), or
  /// PointGrid::kNone. `at` and gate in m, ω_o in m².
  [[nodiscard]] int associate(const Eigen::Vector3f& at, float occupancy, float gate_m, double occupancy_weight) const;
  /// One closed-form step over such pairs. The step moves the source as it lies under `T`.
  /// `weighted`: by (1/p_r + 1/p_s)⁻¹ (4.18). `mean_squared` gets the mean squared distance of the
  /// pairs, m². Empty with fewer than kMinPairs.
  [[nodiscard]] std::optional<SE3> closed_form_step(const SE3& T, float gate_m, double occupancy_weight, bool weighted,
                                                    double& mean_squared) const;

  /// Score of a pose for ranking, with free space; see Judge::score().
  [[nodiscard]] double score(const SE3& T_a_b) const { return judge_.score(T_a_b); }

  [[nodiscard]] const std::vector<Voxel>& voxels_a() const { return voxels_a_; }
  [[nodiscard]] const std::vector<Voxel>& voxels_b() const { return voxels_b_; }
  /// The voxels of b that look for partners.
  [[nodiscard]] const std::vector<Voxel>& sources_b() const { return sources_b_; }
  [[nodiscard]] const PointGrid& points_a() const { return points_a_; }
  [[nodiscard]] double resolution() const { return resolution_; }
  /// H(m) of the target (3.11), bits, at least kLeastEntropy_bits.
  [[nodiscard]] double entropy_a() const { return entropy_a_; }

 private:
  Judge judge_;
  double resolution_;
  bool too_large_;
  std::vector<Voxel> voxels_a_, voxels_b_, sources_b_;  // empty for maps that are too large
  PointGrid points_a_;
  double entropy_a_;
};

/// The centres of voxels, m.
[[nodiscard]] std::vector<Eigen::Vector3f> centres_of(const std::vector<Voxel>& voxels);
/// Whether a step is too small to go on: below 0.1 mm and 10⁻⁵ rad.
[[nodiscard]] bool negligible(const SE3& step);

}  // namespace cairn::matching
