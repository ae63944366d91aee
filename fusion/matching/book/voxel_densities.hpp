// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fusion/matching/book/point_grid.hpp"

namespace cairn::matching {

/// The sparser one of two maps by local density: how many occupied voxels are within kRadius_voxels of a voxel.
/// EM pairs each of its voxels with as many of the dense map as the densities say (Alg. 3).
struct SparseMap {
  /// The book leaves the radius out.
  static constexpr float kRadius_voxels = 5;
  /// c_i (Alg. 3), at most: a bound on time. The book sees 3.57.
  static constexpr int kMostPartners = 8;

  bool is_b = false;
  std::vector<Eigen::Vector3f> voxels;  ///< that look for partners, m: a fixed sample
  std::vector<int> densities;           ///< of each of them
  double dense_mean = 0;                ///< mean density of the other map
  bool alike = false;                   ///< both densities are the same, rounded: one partner each

  /// c_i of voxel `i`, where the other map has this density.
  [[nodiscard]] int partners(std::size_t i, double dense) const;
};

/// Of a tie, b is the sparser one. `resolution`: of a voxel, m.
[[nodiscard]] SparseMap sparser_of(const PointGrid& a, const PointGrid& b, double resolution);

}  // namespace cairn::matching
