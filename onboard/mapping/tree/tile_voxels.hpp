// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::mapping {

/// Log-odds of all voxels of a tile, that is, of a node three levels above them, SemanticNode::kAbsent where nothing is
/// known; in the order of the tree: the voxels of the first child before those of the second, on each level.
inline constexpr int kTileEdge = 8, kTileVoxels = 512;
using TileVoxels = std::array<float, kTileVoxels>;
/// Their labels, in the same order; none of voxels that are not occupied.
using TileLabels = std::array<VoxelLabel, kTileVoxels>;

/// What coordinate `at` (0…7 voxels within the tile) on an axis (0…2) adds to a voxel's index.
[[nodiscard]] constexpr int tile_index(int axis, int at) { return ((at & 1) | (at & 2) << 2 | (at & 4) << 4) << axis; }

/// All voxels below a node; a leaf or an absent node stands for all of them.
void read_voxels(const SemanticNode& node, float* voxels, int count);
inline void read_voxels(const SemanticNode& node, TileVoxels& voxels) { read_voxels(node, voxels.data(), kTileVoxels); }
/// Their labels; false where none has one.
bool read_labels(const SemanticNode& node, TileLabels& labels);

/// Divides a leaf into the voxels of a tile and brings it up to date with them. False where nothing is known of any:
/// then it stays as it is. `labels`: of those that are known; null: none has one.
bool write_voxels(const TileVoxels& voxels, NodeWriter& writer, SemanticNode* leaf, const TileLabels* labels = nullptr);

}  // namespace cairn::mapping
