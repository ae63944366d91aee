// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tools/simulator/world/floor_plan.hpp"

namespace cairn::simulator {

using Path = std::vector<Eigen::Vector2d>;

inline constexpr double kPathStep = 0.1;     ///< m, about, between the points of a smooth path
inline constexpr double kPassable = 0.45;    ///< m, the least clearance of a path's points
inline constexpr double kRoomToTurn = 0.72;  ///< m, the least clearance where a robot may turn on the spot

/// A* over the cells of the plan, in the middle of free space where there is a choice. Null when `to` cannot be
/// reached or either end lies too close to an obstacle.
[[nodiscard]] std::optional<Path> find_path(const FloorPlan& plan, const Eigen::Vector2d& from,
                                            const Eigen::Vector2d& to);

/// The same way without corners: evenly spaced points that pull each other straight, as far as clearance allows.
[[nodiscard]] Path smooth(const FloorPlan& plan, const Path& path);

[[nodiscard]] double path_length(const Path& path);

}  // namespace cairn::simulator
