// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::team_run {

/// The part of space that another map knows.
struct Area {
  const mapping::SemanticOcTree& map;
  SE3 T_map_area;  ///< where it lies in the map that is compared
};

/// Intersection over union of the occupied leaves of a map and of the true world, 0…1. Only places that the map knows
/// count, and, with `within`, that this area knows too. Leaves that are one voxel apart fit. Nothing if no leaf is
/// occupied. `T_world_map` takes a point of the map to the world.
[[nodiscard]] std::optional<double> iou_with_world(const mapping::SemanticOcTree& map, const SE3& T_world_map,
                                                   const mapping::SemanticOcTree& world, const Area* within = nullptr);

[[nodiscard]] std::size_t occupied_leaves(const mapping::SemanticOcTree& map);

/// A robot where it stands at the end.
struct Standing {
  SE3 T_odom_base;   ///< estimated
  SE3 T_world_base;  ///< true
  [[nodiscard]] SE3 T_world_odom() const { return T_world_base * T_odom_base.inverse(); }
};

/// The error of where a sees b: T_true⁻¹·T_estimated of b's base in a's base. The drift of both is in it. `T_a_b` takes
/// a point of b's odom to a's.
[[nodiscard]] SE3 sight_error(const Standing& a, const Standing& b, const SE3& T_a_b);

/// Whether the merge itself is wrong, not just inexact: more than 1 m or 10°.
[[nodiscard]] bool is_wrong_merge(const SE3& sight_error);

}  // namespace cairn::team_run
