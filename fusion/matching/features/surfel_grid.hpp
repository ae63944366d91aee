// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fusion/matching/features/cell_index.hpp"
#include "fusion/matching/features/map_voxels.hpp"

namespace cairn::matching {

/// What the occupied voxels in and around one cell look like: a point on the surface and its normal.
struct Surfel {
  /// m, map frame; on the local plane where the surfel is flat()
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  /// Unit length, sign arbitrary; zero where too few voxels are near.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float variation = 0;  ///< smallest of the three eigenvalues of the spread, over their sum: 0 plane, 1/3 ball
  float occupancy = 0;  ///< mean probability of the cell's voxels
  /// Whether the normal points to where free space was observed, and none behind; see facing_free_space().
  bool oriented = false;
  bool thin = false;  ///< free space was observed on both sides: the point is in the middle of a wall
  /// m, from the point to the faces of a thin wall, as the spread along the normal shows it
  float half_thickness = 0;

  /// Whether there is a plane to speak of; elsewhere the point is the mean of the cell's voxels.
  [[nodiscard]] bool flat() const { return variation < 0.1F; }
  /// Walls, edges and clutter tell places apart; floors and ceilings agree everywhere (prototype's finding 2), and a
  /// voxel alone, without a normal, can agree with nothing.
  [[nodiscard]] bool structure() const {
    return !normal.isZero() && (std::abs(normal.z()) < 0.7F || variation > 0.05F);
  }
};

/// How far the source's point lies from where it would be had both maps seen the same of a wall, in m along the
/// target's normal: one may have seen both faces of a thin wall, and has its middle in the cell, the other only one.
/// `cosine`: of the normals.
[[nodiscard]] inline float off_the_face(const Surfel& target, const Surfel& source, float cosine) {
  if (target.thin && source.oriented) return cosine > 0 ? target.half_thickness : -target.half_thickness;
  return target.oriented && source.thin ? -source.half_thickness : 0;
}

/// Surfels of one cell size, kept as a map grows: replacing some tiles costs what lies in and next to them. What it
/// gives depends on the voxels it holds only, never on the order in which they came.
class SurfelGrid {
 public:
  /// A cell is a cube of `voxels_per_cell`³ voxels of edge `resolution_m`; a divisor of a tile's 8.
  SurfelGrid(int voxels_per_cell, float resolution_m);

  [[nodiscard]] float cell_m() const { return cell_m_; }
  /// The tile's occupied voxels are now these, in depth-first order.
  void replace_tile(TileKey tile, std::span<const Voxel> voxels);
  /// Computes what the replaced tiles changed.
  void refresh();
  /// In order of cells: x, then y, then z. Valid after refresh().
  [[nodiscard]] std::vector<Surfel> surfels() const;

 private:
  /// Sums over a cell's voxels, relative to its centre.
  struct Cell {
    Eigen::Vector3i cell;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    float occupancy = 0;
    int count = 0;
    bool stale = false;
    Surfel surfel{};

    void clear() {
      sum.setZero();
      squares.setZero();
      occupancy = 0;
      count = 0;
    }
  };
  Cell& cell_at(const Eigen::Vector3i& cell);
  void clear_tile(TileKey tile);
  void put_in_order();
  void make_stale(int i);
  [[nodiscard]] Surfel fit(const Cell& cell) const;
  [[nodiscard]] Eigen::Vector3f centre(const Cell& cell) const {
    return (cell.cell.cast<float>().array() + 0.5F) * cell_m_;
  }

  int voxels_per_cell_;
  float resolution_m_, cell_m_;
  CellIndex index_;
  std::vector<Cell> cells_;
  std::vector<int> stale_;
  std::vector<std::pair<std::uint64_t, int>> order_;  // of cells_, by place; sorted once for each cell that appears
};

}  // namespace cairn::matching
