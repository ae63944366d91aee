// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "onboard/client/robot_stream.hpp"
#include "onboard/client/view/costmap.hpp"
#include "onboard/client/view/planner_view.hpp"

namespace cairn::cli {

/// What a robot can drive on and how near obstacles are, as one line for programs of any language. Grids are base64, x
/// fastest: `cost` has a byte for each cell, as client::Costmap; `distance_cm` has two, little endian: from the cell to
/// the nearest lethal one, 65535 where there is none. `nearest_m`: from base_link to the nearest occupied voxel in the
/// block of client::DistanceField, or null.
[[nodiscard]] nlohmann::ordered_json costmap_line(const client::PlannerView& view, const client::PoseMessage& pose,
                                                  const client::CostmapConfig& robot);

}  // namespace cairn::cli
