// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "fusion/matching/features/cell_index.hpp"
#include "fusion/matching/features/surfel_grid.hpp"

namespace cairn::matching {

/// For every cell near a surface, the surfel nearest to the cell's centre, spread from the surfels outwards
/// (brushfire). So one look-up finds a neighbour that is nearest up to the size of a cell. Memory grows with the
/// surface, not with the volume: cells are kept in bricks of 8³, at most kMostBricks of them (400 MB); a map that is
/// strewn over more has surfels that are not found.
class NearestGrid {
 public:
  static constexpr int kNone = -1;
  static constexpr std::size_t kMostBricks = 200'000;

  /// Surfels up to `reach_m` away from a cell's centre are known to it. `surfels` must outlive the grid.
  NearestGrid(std::span<const Surfel> surfels, float cell_m, float reach_m);

  /// Index of the surfel near `point` (m), or kNone where there is none within `gate_m`. Any float is safe.
  [[nodiscard]] int nearest(const Eigen::Vector3f& point, float gate_m) const;

 private:
  static constexpr int kBits = 3, kEdge = 1 << kBits;
  using Brick = std::array<int, kEdge * kEdge * kEdge>;

  [[nodiscard]] static std::size_t slot(const Eigen::Vector3i& cell);
  int* entry(const Eigen::Vector3i& cell);  // none beyond kMostBricks
  void spread(float reach_m);
  void offer(const Eigen::Vector3i& cell, int surfel, float squared_reach, std::vector<Eigen::Vector3i>& changed);
  [[nodiscard]] float squared_distance(const Eigen::Vector3i& cell, int surfel) const;

  std::span<const Surfel> surfels_;
  float cell_m_, inverse_cell_;
  CellIndex index_;
  std::vector<Brick> bricks_;
};

}  // namespace cairn::matching
