// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Centres of all occupied voxels, in metres in the map frame, in depth-first order; a pruned leaf gives every voxel it
/// stands for. Errc::kLimit above `max_points`.
Result<std::vector<Eigen::Vector3f>> occupied_voxel_centres(const SemanticOcTree& tree,
                                                            std::size_t max_points = 100'000'000);

/// Binary little-endian PLY with x, y, z as floats (G. Turk, "The PLY Polygon File Format").
[[nodiscard]] std::vector<std::byte> encode_ply(std::span<const Eigen::Vector3f> points);
/// Binary PCD v0.7 with x, y, z as floats (Point Cloud Library).
[[nodiscard]] std::vector<std::byte> encode_pcd(std::span<const Eigen::Vector3f> points);

}  // namespace cairn::mapping
