// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Occupied voxels of the map; a pruned leaf counts as every voxel that it stands for. Leaves are
/// counted as whole cubes: time grows with the number of leaves.
[[nodiscard]] std::uint64_t count_occupied_voxels(const SemanticOcTree& tree);

/// Voxels that may be listed one by one, unless the number of nodes justifies more. A few leaves of a
/// crafted map stand for up to 2⁴⁸ voxels.
inline constexpr std::uint64_t kSpareVoxels = 2'000'000, kVoxelsPerNode = 64;

/// How many voxels of the map may be listed: as many as `tree` justifies, kSpareVoxels + kVoxelsPerNode ·
/// nodes, and at most `max_points`.
[[nodiscard]] std::size_t most_listable(const SemanticOcTree& tree, std::size_t max_points);

/// How many occupied voxels the map has. Errc::kLimit if it has more than most_listable().
Result<std::size_t> listable_voxels(const SemanticOcTree& tree, std::size_t max_points = 100'000'000);

/// Calls `visit(point)` or `visit(point, leaf)` for the centre of each occupied voxel, in metres in the map frame
/// (float), in depth-first order. Ask listable_voxels() first.
template <class Visit>
void for_each_occupied_voxel(const SemanticOcTree& tree, Visit&& visit) {
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const unsigned edge = 1U << (SemanticOcTree::kDepth - leaf.getDepth());
    const auto key = [&](unsigned axis, unsigned step) { return static_cast<octomap::key_type>(first[axis] + step); };
    for (unsigned z = 0; z < edge; ++z)
      for (unsigned y = 0; y < edge; ++y)
        for (unsigned x = 0; x < edge; ++x) {
          const octomap::point3d centre = tree.keyToCoord(octomap::OcTreeKey(key(0, x), key(1, y), key(2, z)));
          const Eigen::Vector3f point(centre.x(), centre.y(), centre.z());
          if constexpr (std::is_invocable_v<Visit&, const Eigen::Vector3f&, const SemanticNode&>) {
            visit(point, *leaf);
          } else {
            visit(point);
          }
        }
  }
}

/// The centres as a list. Errors: those of listable_voxels().
Result<std::vector<Eigen::Vector3f>> occupied_voxel_centres(const SemanticOcTree& tree,
                                                            std::size_t max_points = 100'000'000);

/// A voxel's centre as a PLY file holds it: the colour of its class, and the trainId or kNoClass.
struct LabelledCentre {
  Eigen::Vector3f centre;
  std::uint8_t class_id;
};
/// The same voxels as occupied_voxel_centres() in the same order; none if no voxel has a label. Errors: the same.
Result<std::vector<LabelledCentre>> labelled_voxel_centres(const SemanticOcTree& tree,
                                                           std::size_t max_points = 100'000'000);

/// Binary little-endian PLY with x, y, z as floats (G. Turk, "The PLY Polygon File Format").
[[nodiscard]] std::vector<std::byte> encode_ply(std::span<const Eigen::Vector3f> points);
/// The same with the properties red, green, blue and label (trainId; 255: none, painted light grey).
[[nodiscard]] std::vector<std::byte> encode_ply(std::span<const LabelledCentre> points);
/// Binary PCD v0.7 with x, y, z as floats (Point Cloud Library).
[[nodiscard]] std::vector<std::byte> encode_pcd(std::span<const Eigen::Vector3f> points);

}  // namespace cairn::mapping
