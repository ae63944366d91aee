// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/client/view/costmap.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// A costmap of the header's frame: −1 unknown, 0 free … 100 lethal. Its plane lies at z = 0 of that frame.
[[nodiscard]] OccupancyGrid occupancy_grid_of(const client::Costmap& costmap, const Header& header, Arena& arena);

}  // namespace cairn::ros
