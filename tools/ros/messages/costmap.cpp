// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/costmap.hpp"

#include <algorithm>

namespace cairn::ros {

OccupancyGrid occupancy_grid_of(const client::Costmap& costmap, const Header& header, Arena& arena) {
  OccupancyGrid message{};
  message.header = header;
  message.info.map_load_time = header.stamp;
  message.info.resolution = static_cast<float>(costmap.resolution_m);
  message.info.width = message.info.height = static_cast<std::uint32_t>(costmap.cells);
  message.info.origin = {.position = {.x = costmap.x_m, .y = costmap.y_m, .z = 0},
                         .orientation = {.x = 0, .y = 0, .z = 0, .w = 1}};
  const auto cells = costmap.occupancy_grid();
  std::ranges::copy(cells, arena.sequence(message.data, cells.size()).begin());
  return message;
}

}  // namespace cairn::ros
