// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/result.hpp"

namespace cairn::matching {

/// Settings of MapFeatures.
struct FeatureConfig {
  /// Edge of a fine cell, m. It is rounded down to 1, 2 or 4 voxels. A coarse cell has twice the
  /// edge. From a prototype: cells of 0.2 m give errors of 4 to 50 mm on its 13 pairs of maps.
  double fine_cell_m = 0.2;
  /// Voxels in the 27 cells around a cell that a normal needs. Chosen by hand, not tuned.
  int min_normal_voxels = 5;
  /// Fine cells of a map, at most, as far as cells of 4 voxels go: a bound on memory and time. The
  /// cells of a larger map are 2 or 4 voxels. update() leaves their size as it is.
  std::size_t most_cells = 250'000;
};

/// The features of one map: surfels at two cell sizes, about 0.2 and 0.4 m.
/// They are kept up to date while the map grows. Free space is read from the tree itself.
class MapFeatures {
 public:
  /// Reads the whole map. The map must outlive the features, and nobody may edit it while they are
  /// used. Errors: kLimit for a map of more than kMaxVoxels occupied voxels.
  static Result<MapFeatures> build(const mapping::SemanticOcTree& map, const FeatureConfig& config = {});
  static Result<MapFeatures> build(mapping::SemanticOcTree&&, const FeatureConfig& = {}) = delete;

  /// Reads the changed tiles again (see Mapper::take_changed_tiles()). The result equals build()'s,
  /// but for the weights of voxels whose log-odds merely moved: such tiles are not told.
  void update(std::span<const mapping::TileKey> changed);

  [[nodiscard]] const mapping::SemanticOcTree& map() const { return *map_; }
  [[nodiscard]] double resolution() const { return map_->getResolution(); }
  /// Edges of the cells, m.
  [[nodiscard]] float fine_m() const { return fine_grid_.cell_m(); }
  [[nodiscard]] float coarse_m() const { return coarse_grid_.cell_m(); }
  /// Sorted by cell: x, then y, then z.
  [[nodiscard]] std::span<const Surfel> fine() const { return fine_; }
  [[nodiscard]] std::span<const Surfel> coarse() const { return coarse_; }

 private:
  MapFeatures(const mapping::SemanticOcTree& map, int voxels_per_fine_cell, int min_normal_voxels);
  void replace(mapping::TileKey tile, std::span<const Voxel> voxels);
  void finish();

  const mapping::SemanticOcTree* map_;
  SurfelGrid fine_grid_, coarse_grid_;
  std::vector<Surfel> fine_, coarse_;
};

/// The book's map entropy (3.10, 3.11), in bits: the mean of −p log2 p over occupied voxels.
/// 0 for an empty map.
[[nodiscard]] double book_map_entropy(std::span<const Voxel> voxels);

}  // namespace cairn::matching
