// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
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
///
/// A brick is filled once somebody has asked for kFewQuestions places in it. Until then each answer
/// is looked for among the surfels around. Most comparisons of two maps look at a small part of
/// either more than once. So one grid is for one thread at a time, although nearest() is const.
class NearestGrid {
 public:
  static constexpr int kNone = -1;
  /// Bricks, at most: 400 MB if all of them are asked for. A bound on memory. In a larger map some surfels are not
  /// found.
  static constexpr std::size_t kMostBricks = 200'000;
  /// Answers that are looked for before a brick is filled. They are the same. Chosen by hand, not tuned.
  static constexpr int kFewQuestions = 48;

  /// A cell knows surfels up to `reach_m` away from its centre. `surfels` must outlive the grid.
  NearestGrid(std::span<const Surfel> surfels, float cell_m, float reach_m);

  /// Index of the surfel near `point` (m), or kNone where there is none within `gate_m`. Any float
  /// is safe.
  [[nodiscard]] int nearest(const Eigen::Vector3f& point, float gate_m) const;

 private:
  static constexpr int kBits = 3;
  static constexpr std::size_t kEdge = 1 << kBits;  // cells along the edge of a brick
  using Brick = std::array<int, kEdge * kEdge * kEdge>;
  // Bricks that are allocated at once: 128 kB. A growing vector would copy all of them now and then.
  static constexpr std::size_t kChunk = 64;
  using Chunk = std::array<Brick, kChunk>;
  class Filling;

  /// The box around the surfels whose points lie in one brick, m.
  struct Home {
    Eigen::Vector3i place;
    Eigen::AlignedBox3f box;
  };

  [[nodiscard]] Eigen::Vector3i brick_around(const Eigen::Vector3f& point) const;
  [[nodiscard]] int number_of(const Eigen::Vector3i& place);
  void settle(std::vector<Home>& homes);
  void reach_out(const std::vector<Home>& homes);
  template <class Visit>
  void for_surfels(const Eigen::AlignedBox3f& box, const Visit& visit) const;
  [[nodiscard]] std::vector<int> surfels_near(const Eigen::Vector3i& place) const;
  [[nodiscard]] int nearest_to_centre(std::size_t i, const Eigen::Vector3i& cell) const;
  [[nodiscard]] int look_for(const Eigen::Vector3i& cell) const;
  void fill(std::size_t i, const Eigen::Vector3i& place) const;
  [[nodiscard]] static std::size_t slot(const Eigen::Vector3i& cell);

  std::span<const Surfel> surfels_;
  float cell_m_, inverse_cell_, reach_m_;
  CellIndex index_;                      // of all bricks within reach of a surfel; those with surfels first
  std::vector<int> first_;               // where a brick's surfels begin in settled_, and the end
  std::vector<int> settled_;             // surfels by brick
  std::vector<Eigen::Vector3f> points_;  // theirs, in the same order
  // Where a brick's cells are in chunks_. Negative: the questions that are left until it is filled.
  mutable std::vector<int> cells_of_;
  mutable std::vector<std::unique_ptr<Chunk>> chunks_;
  mutable std::size_t count_ = 0;  // of filled bricks
};

}  // namespace cairn::matching
