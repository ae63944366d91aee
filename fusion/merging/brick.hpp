// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "onboard/mapping/semantic_octree.hpp"

namespace cairn::merging {

/// Log-odds of all voxels of a node three levels above them, SemanticNode::kAbsent where nothing is known; in the order
/// of the tree: the voxels of the first child before those of the second, on each level.
inline constexpr int kBrickEdge = 8, kBrickVoxels = 512;
using Brick = std::array<float, kBrickVoxels>;

/// What coordinate `at` (0…7 voxels within the brick) on an axis (0…2) adds to a voxel's index.
[[nodiscard]] constexpr int brick_index(int axis, int at) { return ((at & 1) | (at & 2) << 2 | (at & 4) << 4) << axis; }

/// All voxels below a node; a leaf or an absent node stands for all of them.
void read_brick(const SemanticNode& node, Brick& brick);
/// Divides a leaf into the voxels of a brick and brings it up to date with them. False where nothing is known of any:
/// then it stays as it is.
bool write_brick(const Brick& brick, NodeWriter& writer, SemanticNode* leaf);

/// Bricks of a map that lie near each other, read from its tree once each: a map that is turned against the grid is
/// looked up voxel by voxel, and in an array that costs a fraction of a descent in the tree. A window that moves with
/// the cubes asked for: the place of a brick is its coordinates modulo the window's extent, so memory is bounded.
class BrickWindow {
 public:
  explicit BrickWindow(const SemanticNode* root) : root_(root) {}

  /// Reads what is not yet there of the bricks from `low` to `high` (both inclusive, in bricks from the tree's corner;
  /// outside of the tree nothing is known). At most kExtent of them along each axis.
  void hold(const Eigen::Vector3i& low, const Eigen::Vector3i& high);
  /// The log-odds of the voxel with these keys is voxels()[Σ index(axis, key)], if its brick is held.
  [[nodiscard]] const float* voxels() const { return voxels_.data(); }
  [[nodiscard]] static int index(int axis, int key) {
    const int brick = (key >> 3) & (kExtent[static_cast<std::size_t>(axis)] - 1);
    return brick * kStride[static_cast<std::size_t>(axis)] + brick_index(axis, key & (kBrickEdge - 1));
  }

 private:
  static constexpr std::array<int, 3> kExtent{16, 16, 4};  // bricks; powers of two
  static constexpr std::array<int, 3> kStride{kBrickVoxels, kBrickVoxels* kExtent[0],
                                              kBrickVoxels* kExtent[0] * kExtent[1]};
  static constexpr std::size_t kBricks = std::size_t{kExtent[0]} * kExtent[1] * kExtent[2];

  void read(const Eigen::Vector3i& brick, float* into) const;

  const SemanticNode* root_;
  std::vector<float> voxels_;
  std::vector<Eigen::Vector3i> held_;  // which brick is at each place
};

}  // namespace cairn::merging
