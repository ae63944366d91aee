// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// A point in its voxel: the path from the root, as TileKey has it but down to the voxel.
struct PlacedPoint {
  std::uint64_t path;
  std::uint32_t point;
};
using PlacedPoints = std::span<const PlacedPoint>;

/// The path of a voxel; 3 bits for each level, the root's first.
[[nodiscard]] std::uint64_t voxel_path(const octomap::OcTreeKey& key);

/// Adds point number `index` at its voxel. False: it lies outside of the tree, or is not finite.
bool place_point(const SemanticOcTree& tree, const Eigen::Vector3f& point, std::uint32_t index,
                 std::vector<PlacedPoint>& placed);
/// Sorts by voxel, then by point.
void sort_by_voxel(std::vector<PlacedPoint>& placed);

/// Visits the occupied voxels that hold points, each once, and leaves the tree canonical. `visit(voxel, points)` may
/// change the voxel; it returns whether it did.
template <class Visit>
class OccupiedWalk {
 public:
  OccupiedWalk(SemanticOcTree& tree, Visit visit)
      : tree_(tree), writer_(tree.writer(0)), occupied_(tree.sensor_model().occupied), visit_(std::move(visit)) {}

  /// Points as sort_by_voxel() leaves them. Returns how many lie in voxels that are free or unknown.
  std::size_t run(PlacedPoints placed) {
    if (tree_.getRoot() == nullptr || placed.empty()) return placed.size();
    bool made = false;
    below(tree_.root_or_new(made), 0, placed);
    tree_.settle_count();
    return missed_;
  }

 private:
  static unsigned child_at(std::uint64_t path, unsigned depth) {
    return static_cast<unsigned>(path >> (3 * (SemanticOcTree::kDepth - 1 - depth))) & 7U;
  }

  /// True: something below the node has changed. As deep as the tree: 16 levels.
  // NOLINTNEXTLINE(misc-no-recursion)
  bool below(SemanticNode* node, unsigned depth, PlacedPoints range) {
    const bool leaf = depth == SemanticOcTree::kDepth, pruned = node->block() == nullptr;
    if (pruned && node->getLogOdds() < occupied_) {
      missed_ += range.size();
      return false;
    }
    if (leaf) return visit_(*node, range);
    if (pruned) writer_.expand(node);
    bool changed = false;
    while (!range.empty()) {
      const unsigned child = child_at(range.front().path, depth);
      const auto end =
          std::ranges::find_if(range, [&](const PlacedPoint& p) { return child_at(p.path, depth) != child; });
      const PlacedPoints part = range.first(static_cast<std::size_t>(end - range.begin()));
      range = range.subspan(part.size());
      if (node->block()[child].present())
        changed |= below(node->block() + child, depth + 1, part);
      else
        missed_ += part.size();
    }
    if (changed || pruned) writer_.refresh(node);
    return changed;
  }

  SemanticOcTree& tree_;
  NodeWriter& writer_;
  float occupied_;
  Visit visit_;
  std::size_t missed_ = 0;
};

}  // namespace cairn::mapping
