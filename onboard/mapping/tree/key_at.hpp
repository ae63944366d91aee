// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// The key of the voxel around a point (m, map frame); none beyond what the tree can hold, or for what is no number.
/// OctoMap's coordToKeyChecked() converts to int before it looks whether that is possible.
[[nodiscard]] inline std::optional<octomap::OcTreeKey> key_at(const SemanticOcTree& tree,
                                                              const Eigen::Vector3d& point) {
  const double farthest = tree.getResolution() * (1U << (SemanticOcTree::kDepth - 1));
  octomap::OcTreeKey key;
  if (!(point.array().abs() < farthest).all() || !tree.coordToKeyChecked(point.x(), point.y(), point.z(), key))
    return std::nullopt;
  return key;
}

}  // namespace cairn::mapping
