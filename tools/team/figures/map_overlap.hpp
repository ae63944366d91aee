// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::team {

/// What another map knows something of.
struct Area {
  const SemanticOcTree& map;
  SE3 T_map_area;  ///< where it lies in the map that is compared
};

/// Occupied leaves of a map that fit the true world, over those of both (intersection over union), where the map knows
/// something; one voxel of the map searched is allowed for. None where nothing is occupied. `T_world_map` takes a point
/// of the map to the world.
/// `within`: only where this one knows something, too.
[[nodiscard]] std::optional<double> iou_with_world(const SemanticOcTree& map, const SE3& T_world_map,
                                                   const SemanticOcTree& world, const Area* within = nullptr);

[[nodiscard]] std::size_t occupied_leaves(const SemanticOcTree& map);

/// A robot where it stands at the end.
struct Standing {
  SE3 T_odom_base;   ///< as it thinks
  SE3 T_world_base;  ///< in truth
  [[nodiscard]] SE3 T_world_odom() const { return T_world_base * T_odom_base.inverse(); }
};

/// By how much it is wrong where b is, as a sees it: T_true⁻¹·T_estimated of b's base in a's base. What teammates want
/// to know of each other; the drift of both is in it. `T_a_b` takes a point of b's odom to a's.
[[nodiscard]] SE3 sight_error(const Standing& a, const Standing& b, const SE3& T_a_b);

/// An error that says the merge itself is wrong, not just inexact.
[[nodiscard]] bool is_wrong_merge(const SE3& sight_error);

}  // namespace cairn::team
