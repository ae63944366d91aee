// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "fusion/matching/features/cell_index.hpp"
#include "fusion/matching/features/surfel_grid.hpp"

namespace cairn::matching {

/// Finds the surfel nearest to a point, up to the size of a cell, with one look-up. Each cell near
/// a surface keeps the surfel nearest to its centre, or the first of them. Memory grows with the
/// surface, not with the volume, because cells are kept in bricks of 8³.
class NearestGrid {
 public:
  static constexpr int kNone = -1;
  /// Bricks, at most: 400 MB, and as much again while the grid is made. A bound on memory. In a larger map some surfels
  /// are not found.
  static constexpr std::size_t kMostBricks = 200'000;

  /// A cell knows surfels up to `reach_m` away from its centre. `surfels` must outlive the grid.
  NearestGrid(std::span<const Surfel> surfels, float cell_m, float reach_m);

  /// Index of the surfel near `point` (m), or kNone where there is none within `gate_m`. Any float
  /// is safe.
  [[nodiscard]] int nearest(const Eigen::Vector3f& point, float gate_m) const;

 private:
  class Filling;

  static constexpr int kBits = 3;
  static constexpr std::size_t kEdge = 1 << kBits;  // cells along the edge of a brick
  using Brick = std::array<int, kEdge * kEdge * kEdge>;
  // Bricks that are allocated at once: 128 kB. A growing vector would copy all of them now and then.
  static constexpr std::size_t kChunk = 64;
  using Chunk = std::array<Brick, kChunk>;

  [[nodiscard]] Brick& brick(std::size_t i) { return (*chunks_[i / kChunk])[i % kChunk]; }
  [[nodiscard]] const Brick& brick(std::size_t i) const { return (*chunks_[i / kChunk])[i % kChunk]; }
  [[nodiscard]] static std::size_t slot(const Eigen::Vector3i& cell);

  std::span<const Surfel> surfels_;
  float inverse_cell_;
  CellIndex index_;
  std::vector<std::unique_ptr<Chunk>> chunks_;
};

}  // namespace cairn::matching
