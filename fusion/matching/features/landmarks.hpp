// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "fusion/matching/features/surfel_grid.hpp"

namespace cairn::matching {

/// A point of the plan that another map can find again, however little the two maps share: a corner
/// of walls, a pillar, a trunk.
struct Landmark {
  Eigen::Vector2f at = Eigen::Vector2f::Zero();  ///< m; where the walls around it meet
  /// Mean (cos 4θ, sin 4θ) of the directions θ that the walls face. Its length is 1 where walls
  /// cross at a right angle, and near 0 for a round trunk.
  Eigen::Vector2f cross = Eigen::Vector2f::Zero();
  /// Mean normal towards free space, of the walls whose free side is known.
  Eigen::Vector2f facing = Eigen::Vector2f::Zero();
  float strength = 0;  ///< surfels across the main direction of the walls
};

/// The strongest landmarks, at most `most`, best first. `surfels`: the fine ones of a map that stands
/// upright. The surfel of a wall is a line on the plan. A landmark is the point nearest to all lines
/// around it (Förstner and Gülch, ISPRS 1987). The lines must have several directions and pass it
/// closely. A thin pillar or trunk is such a point, too.
[[nodiscard]] std::vector<Landmark> landmarks(std::span<const Surfel> surfels, std::size_t most);

}  // namespace cairn::matching
