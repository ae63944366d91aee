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

inline constexpr int kKeyOrigin = 1 << (SemanticOcTree::kDepth - 1);  ///< tree key of the voxel from the origin on

/// One occupied voxel, the unit of the book's maps (2.1).
struct Voxel {
  Eigen::Vector3f centre;  ///< m, map frame
  Eigen::Vector3i key;     ///< tree key less 2¹⁵: voxel k spans [k, k+1) edges
  float occupancy;         ///< probability, in (0.5, 1]
  std::uint32_t label_id;  ///< as SemanticNode::label_id(); 0 for none
};

inline constexpr std::size_t kMaxVoxels = 5'000'000;  ///< of one map; a crafted file can claim 2⁴⁸

/// Every occupied voxel in depth-first order, in which the voxels of a tile are adjacent; a pruned leaf gives all that
/// it stands for. Errc::kLimit above `max_voxels`.
Result<std::vector<Voxel>> occupied_voxels(const SemanticOcTree& map, std::size_t max_voxels = kMaxVoxels);
/// The occupied voxels of one tile, in the same order.
[[nodiscard]] std::vector<Voxel> occupied_voxels(const SemanticOcTree& map, TileKey tile);
[[nodiscard]] TileKey tile_of(const Voxel& voxel);

/// What a map says about a place. Looks into the tree, which must outlive it and not be edited meanwhile; relies on
/// the canonical form (an inner node is as occupied as its most occupied child).
class FreeSpace {
 public:
  explicit FreeSpace(const SemanticOcTree& map);

  /// Whether the voxel at `point` (m, map frame) was observed free and nothing occupied is in the cube around it that
  /// the tree has as one node, of kMarginM or kMarginVoxels, whichever is more: two maps of one surface often have it
  /// in voxels that are neighbours, however large these are.
  [[nodiscard]] bool contains(const Eigen::Vector3f& point) const { return free_at(point, margin_depth_); }
  /// Whether the voxel at `point` itself was.
  [[nodiscard]] bool seen_free(const Eigen::Vector3f& point) const { return free_at(point, SemanticOcTree::kDepth); }

  static constexpr double kMarginM = 0.4, kMarginVoxels = 4;

 private:
  [[nodiscard]] bool free_at(const Eigen::Vector3f& point, unsigned margin_depth) const;

  const SemanticNode* root_;
  float inverse_resolution_, threshold_;
  unsigned margin_depth_;
};

}  // namespace cairn::matching
