// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "fusion/matching/features/cell_index.hpp"
#include "fusion/matching/features/surfel_grid.hpp"

namespace cairn::matching {

/// Finds the surfel nearest to a point, up to the size of a cell, with one look-up. Each cell near
/// a surface keeps the surfel nearest to its centre (brushfire from the surfels outwards). Memory
/// grows with the surface, not with the volume, because cells are kept in bricks of 8³.
class NearestGrid {
 public:
  static constexpr int kNone = -1;
  /// Bricks, at most: 400 MB. A bound on memory. In a larger map some surfels are not found.
  static constexpr std::size_t kMostBricks = 200'000;

  /// A cell knows surfels up to `reach_m` away from its centre. `surfels` must outlive the grid.
  NearestGrid(std::span<const Surfel> surfels, float cell_m, float reach_m);

  /// Index of the surfel near `point` (m), or kNone where there is none within `gate_m`. Any float
  /// is safe.
  [[nodiscard]] int nearest(const Eigen::Vector3f& point, float gate_m) const;

 private:
  static constexpr int kBits = 3, kEdge = 1 << kBits;  // cells along the edge of a brick
  using Brick = std::array<int, kEdge * kEdge * kEdge>;

  [[nodiscard]] static std::size_t slot(const Eigen::Vector3i& cell);
  int* entry(const Eigen::Vector3i& cell);  // null beyond kMostBricks
  void spread(float reach_m);
  void offer(const Eigen::Vector3i& cell, int surfel, float squared_reach, std::vector<Eigen::Vector3i>& changed);
  [[nodiscard]] float squared_distance(const Eigen::Vector3i& cell, int surfel) const;

  std::span<const Surfel> surfels_;
  float cell_m_, inverse_cell_;
  CellIndex index_;
  std::vector<Brick> bricks_;
};

}  // namespace cairn::matching
