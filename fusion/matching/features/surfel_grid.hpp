// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fusion/matching/features/cell_table.hpp"
#include "fusion/matching/features/map_voxels.hpp"

namespace cairn::matching {

/// A small piece of surface: a point and its normal, from the occupied voxels in and around a cell.
/// Each voxel counts by its evidence, the log-odds of its probability.
struct Surfel {
  /// Variation below which a surfel is flat. Chosen by hand, not tuned. A prototype had 0.05.
  static constexpr float kFlatVariation = 0.1F;
  /// Structure is steep or uneven: |z| of its unit normal is below this (45° from level), ...
  static constexpr float kStructureNormalZ = 0.7F;
  /// ... or its variation is above this, and it is not level. Both are from a prototype on 13 pairs of
  /// maps. With floors and ceilings in the search as well, one pair fell from 100 to 87 % success. A
  /// floor is uneven where it lies between two layers of voxels, and where stereo made it thick. A
  /// thick floor of a multicopter's map was matched with a ceiling.
  static constexpr float kStructureVariation = 0.05F;
  /// Evidence of structure, at least, and of a surfel whose place counts in full when two maps are
  /// aligned: one hit of a LiDAR, or two of a stereo camera, whose single points are often elsewhere.
  /// Chosen by hand among 0, 0.8, 1.3, 2 and 3. With 2, fewer pairs of maps of few scans were found.
  static constexpr float kSeenEvidence = 0.8F;
  /// |z| of the unit normal below which a surfel is upright (within 24° of a wall), and above which
  /// it is level (within 32° of a floor). Others are neither. Chosen by hand, not tuned.
  static constexpr float kUprightNormalZ = 0.4F, kLevelNormalZ = 0.85F;

  Eigen::Vector3f point = Eigen::Vector3f::Zero();   ///< m, map frame; on the plane if flat()
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit length, any sign; 0: too few voxels
  /// Smallest eigenvalue of the spread over the sum of all: 0 plane, 1/3 ball.
  float variation = 0;
  float occupancy = 0;  ///< mean probability of the cell's voxels
  /// Sum of the log-odds of the cell's voxels.
  float evidence = kSeenEvidence;
  bool oriented = false;     ///< the normal points to observed free space, and none was seen behind
  bool thin = false;         ///< free space was observed on both sides: the point is inside a wall
  float half_thickness = 0;  ///< m, from the point to the faces of a thin wall

  /// Whether the voxels lie on a plane. If not, the point is the mean of the cell's voxels.
  [[nodiscard]] bool flat() const { return variation < kFlatVariation; }
  /// Whether the surfel is of a wall.
  [[nodiscard]] bool upright() const { return std::abs(normal.z()) < kUprightNormalZ && !normal.isZero(); }
  /// Whether the surfel is of a floor, a ceiling or a table.
  [[nodiscard]] bool level() const { return std::abs(normal.z()) > kLevelNormalZ; }
  /// Whether the surfel tells places apart: walls, edges and clutter do, floors and ceilings do
  /// not. A surfel without a normal is no structure, nor is one that was hardly seen.
  [[nodiscard]] bool structure() const {
    return !normal.isZero() && evidence >= kSeenEvidence &&
           (std::abs(normal.z()) < kStructureNormalZ || (variation > kStructureVariation && !level()));
  }
};

/// Offset of the source's point from the target's point that is due to a thin wall. In m, along the
/// target's normal. One map may have seen both faces and have the middle of the wall, while the
/// other saw one face. `cosine`: of the two normals.
[[nodiscard]] inline float off_the_face(const Surfel& target, const Surfel& source, float cosine) {
  if (target.thin && source.oriented) return cosine > 0 ? target.half_thickness : -target.half_thickness;
  return target.oriented && source.thin ? -source.half_thickness : 0;
}

/// Surfels of one cell size. They are kept up to date while a map grows: replacing a tile costs
/// what lies in the tile and next to it. The result depends on the voxels alone, not on their
/// order.
class SurfelGrid {
 public:
  /// A cell is a cube of `voxels_per_cell`³ voxels. `voxels_per_cell` divides 8, the edge of a
  /// tile. `resolution_m`: edge of a voxel. `min_voxels`: see FeatureConfig.
  SurfelGrid(int voxels_per_cell, float resolution_m, int min_voxels);

  [[nodiscard]] float cell_m() const { return cell_m_; }
  /// Sets the tile's occupied voxels, in depth-first order.
  void replace_tile(mapping::TileKey tile, std::span<const Voxel> voxels);
  /// The same for a tile that has no voxels yet.
  void add_tile(std::span<const Voxel> voxels);
  /// Computes the surfels that the replaced tiles changed.
  void refresh();
  /// In order of cells: x, then y, then z. Valid after refresh().
  [[nodiscard]] std::vector<Surfel> surfels() const;

 private:
  /// Sums over a cell's voxels, relative to its centre, each with its evidence for a weight.
  struct Cell {
    Eigen::Vector3i cell;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    float occupancy = 0, evidence = 0;
    int count = 0;
    bool stale = false;
    Surfel surfel{};

    void clear() {
      sum.setZero();
      squares.setZero();
      occupancy = 0;
      evidence = 0;
      count = 0;
    }
  };
  Cell& cell_at(const Eigen::Vector3i& cell);
  void clear_tile(mapping::TileKey tile);
  void put_in_order();
  void make_stale(int i);
  [[nodiscard]] Surfel fit(const Cell& cell, CellTable::Neighbours& near) const;
  [[nodiscard]] Eigen::Vector3f centre(const Cell& cell) const {
    return (cell.cell.cast<float>().array() + 0.5F) * cell_m_;
  }

  int voxels_per_cell_, min_voxels_;
  float resolution_m_, cell_m_;
  CellTable index_;
  std::vector<Cell> cells_;
  std::vector<int> stale_;
  // Of cells_, by place; sorted once for each cell that appears.
  std::vector<std::pair<std::uint64_t, int>> order_;
};

}  // namespace cairn::matching
