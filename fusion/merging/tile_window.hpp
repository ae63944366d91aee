// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "onboard/mapping/tree/tile_voxels.hpp"

namespace cairn::merging {

/// Tiles of a map that lie near each other, each read from the tree once. A map that is turned against the grid is
/// looked up voxel by voxel: in an array, this costs a fraction of a descent in the tree. The window moves with the
/// cubes that are asked for. A tile's place is its coordinates modulo the window's extent, so memory is bounded.
class TileWindow {
 public:
  explicit TileWindow(const mapping::SemanticNode* root) : root_(root) {}

  /// Reads the tiles from `low` to `high` that are not there yet: both inclusive, in tiles from the tree's corner, and
  /// at most kExtent along each axis. Outside of the tree nothing is known.
  void hold(const Eigen::Vector3i& low, const Eigen::Vector3i& high);
  /// The log-odds of the voxel with these keys is voxels()[Σ index(axis, key)], if its tile is held.
  [[nodiscard]] const float* voxels() const { return voxels_.data(); }
  [[nodiscard]] static int index(int axis, int key) {
    const int tile = (key >> 3) & (kExtent[static_cast<std::size_t>(axis)] - 1);
    return tile * kStride[static_cast<std::size_t>(axis)] + mapping::tile_index(axis, key & (mapping::kTileEdge - 1));
  }

 private:
  static constexpr std::array<int, 3> kExtent{16, 16, 4};  // tiles; powers of two
  static constexpr std::array<int, 3> kStride{mapping::kTileVoxels, mapping::kTileVoxels* kExtent[0],
                                              mapping::kTileVoxels* kExtent[0] * kExtent[1]};
  static constexpr std::size_t kTiles = std::size_t{kExtent[0]} * kExtent[1] * kExtent[2];

  void read(const Eigen::Vector3i& tile, float* into) const;

  const mapping::SemanticNode* root_;
  std::vector<float> voxels_;
  std::vector<Eigen::Vector3i> held_;  // which tile is at each place
};

}  // namespace cairn::merging
