// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "onboard/client/view/planner_view.hpp"

namespace cairn::client {

/// The robot as a costmap sees it. The defaults are a Clearpath Husky's, with its LiDAR.
struct CostmapConfig {
  double size_m = 20;         ///< edge of the square around the robot
  double height_m = 0.9;      ///< clearance that the robot needs above the ground
  double step_m = 0.12;       ///< highest step that it climbs, between neighbouring cells
  double inscribed_m = 0.34;  ///< radius that always hits, whatever the heading: half of the width
  double inflation_m = 0.8;   ///< no cost beyond this distance from an obstacle
  double scaling = 4;         ///< 1/m: cost = 252·exp(−scaling·(distance − inscribed)), as Nav2's inflation layer
  double base_height_m = 0.15;  ///< of base_link above the ground
};

/// A square of the odom frame with a cost for each cell, as Nav2's costmaps: parallel to the axes of odom, x fastest.
struct Costmap {
  static constexpr std::uint8_t kFree = 0, kInscribed = 253, kLethal = 254, kUnknown = 255;

  double resolution_m = 0;
  int cells = 0;            ///< along each edge
  double x_m = 0, y_m = 0;  ///< of the lower corner in odom
  std::vector<std::uint8_t> cost;
  std::vector<float> ground_m;  ///< height of the ground in odom; NaN where none is reached

  [[nodiscard]] std::uint8_t at(int x, int y) const {
    return cost[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells) + static_cast<std::size_t>(x)];
  }
  /// As nav_msgs/OccupancyGrid has it: −1 unknown, 0 free … 100 lethal.
  [[nodiscard]] std::vector<std::int8_t> occupancy_grid() const;
};

/// What the robot at `T_odom_base` can drive on. The ground is followed cell by cell from where the robot stands, so
/// floors above it and slopes are no obstacles. An edge higher than a step, or something in the robot's height above
/// the ground, is lethal; what was never seen stays unknown. The result is a pure function of its arguments.
[[nodiscard]] Costmap make_costmap(const PlannerView& view, const SE3& T_odom_base, const CostmapConfig& config = {});

}  // namespace cairn::client
