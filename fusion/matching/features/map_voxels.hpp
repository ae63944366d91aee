// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "hal/result.hpp"
#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::matching {

/// Tree key of the voxel whose lower corner is the map's origin: 2¹⁵.
inline constexpr int kKeyOrigin = 1 << (mapping::SemanticOcTree::kDepth - 1);

/// One occupied voxel, the unit of the book's maps (2.1).
struct Voxel {
  Eigen::Vector3f centre;  ///< m, map frame
  Eigen::Vector3i key;     ///< tree key less kKeyOrigin; voxel k spans [k, k+1) edges
  float occupancy;         ///< probability, in (0.5, 1]
  std::uint32_t label_id;  ///< as SemanticNode::label_id(); 0 for none
};

/// Occupied voxels of one map, at most. A bound on memory: a crafted file can claim 2⁴⁸ voxels.
inline constexpr std::size_t kMaxVoxels = 5'000'000;

/// Every occupied voxel, depth first, so that the voxels of a tile are adjacent. A pruned leaf
/// gives all voxels in it. Errors: kLimit above `max_voxels`.
Result<std::vector<Voxel>> occupied_voxels(const mapping::SemanticOcTree& map, std::size_t max_voxels = kMaxVoxels);
/// The occupied voxels of one tile, in the same order.
[[nodiscard]] std::vector<Voxel> occupied_voxels(const mapping::SemanticOcTree& map, mapping::TileKey tile);
[[nodiscard]] mapping::TileKey tile_of(const Voxel& voxel);

/// The free space of a map. It looks into the tree, which must outlive it. Nobody may edit the tree
/// meanwhile. The tree must be canonical: an inner node is as occupied as its most occupied child.
class FreeSpace {
 public:
  /// The margin around a place that counts as free, the larger of the two. Two maps of one surface
  /// often have it in neighbouring voxels, however large these are. Chosen by hand, not tuned.
  static constexpr double kMargin_m = 0.4;
  static constexpr double kMargin_voxels = 4;

  explicit FreeSpace(const mapping::SemanticOcTree& map);

  /// Whether the voxel at `point` (m, map frame) was observed free, and the tree's node of the
  /// margin's size around it holds nothing occupied.
  [[nodiscard]] bool contains(const Eigen::Vector3f& point) const { return free_at(point, margin_depth_); }
  /// Whether the voxel at `point` (m, map frame) was observed free.
  [[nodiscard]] bool seen_free(const Eigen::Vector3f& point) const {
    return free_at(point, mapping::SemanticOcTree::kDepth);
  }

 private:
  [[nodiscard]] bool free_at(const Eigen::Vector3f& point, unsigned margin_depth) const;

  const mapping::SemanticNode* root_;
  float inverse_resolution_, threshold_;
  unsigned margin_depth_;
};

}  // namespace cairn::matching
