// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/result.hpp"

namespace cairn::matching {

/// What matching needs to know of one map: surfels at two cell sizes (about 0.2 and 0.4 m, powers of two of the voxel).
/// Kept as the map grows; the free space is read from the tree itself.
class MapFeatures {
 public:
  /// Reads the whole map. `map` must outlive the features and must not be edited while they are used. Errors: kLimit
  /// for a map of more than kMaxVoxels occupied voxels.
  static Result<MapFeatures> build(const SemanticOcTree& map);
  static Result<MapFeatures> build(SemanticOcTree&&) = delete;

  /// Takes in what changed (see Mapper::take_changed_tiles()); the result is the same as that of build().
  void update(std::span<const TileKey> changed);

  [[nodiscard]] const SemanticOcTree& map() const { return *map_; }
  [[nodiscard]] double resolution() const { return map_->getResolution(); }
  [[nodiscard]] float fine_m() const { return fine_grid_.cell_m(); }
  [[nodiscard]] float coarse_m() const { return coarse_grid_.cell_m(); }
  /// In order of cells.
  [[nodiscard]] std::span<const Surfel> fine() const { return fine_; }
  [[nodiscard]] std::span<const Surfel> coarse() const { return coarse_; }

 private:
  MapFeatures(const SemanticOcTree& map, int voxels_per_fine_cell);
  void replace(TileKey tile, std::span<const Voxel> voxels);
  void finish();

  const SemanticOcTree* map_;
  SurfelGrid fine_grid_, coarse_grid_;
  std::vector<Surfel> fine_, coarse_;
};

/// Mean over occupied voxels of −p log2 p, the book's map entropy (3.10, 3.11), in bits; 0 for an empty map.
[[nodiscard]] double book_map_entropy(std::span<const Voxel> voxels);
/// Mean over occupied voxels of the binary entropy, in bits: what is reported as uncertainty.
[[nodiscard]] double binary_map_entropy(std::span<const Voxel> voxels);

}  // namespace cairn::matching
