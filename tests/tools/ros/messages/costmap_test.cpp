// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/costmap.hpp"

#include <gtest/gtest.h>

namespace cairn::ros {
namespace {

TEST(RosCostmap, IsAGridFromItsLowerCorner) {
  client::Costmap costmap{.resolution_m = 0.25, .cells = 2, .x_m = -3, .y_m = 4, .cost = {}, .ground_m = {}};
  costmap.cost = {client::Costmap::kFree, client::Costmap::kLethal, client::Costmap::kUnknown, 0};
  Arena arena;
  const Header header = header_of(Time{}, std::chrono::seconds(7), "odom", arena);
  const OccupancyGrid grid = occupancy_grid_of(costmap, header, arena);
  EXPECT_STREQ(grid.header.frame_id, "odom");
  EXPECT_EQ(grid.info.map_load_time.sec, 7);
  EXPECT_EQ(grid.info.resolution, 0.25F);
  EXPECT_EQ(grid.info.width, 2U);
  EXPECT_EQ(grid.info.height, 2U);
  EXPECT_EQ(grid.info.origin.position.x, -3);
  EXPECT_EQ(grid.info.origin.position.y, 4);
  EXPECT_EQ(grid.info.origin.orientation.w, 1);
  ASSERT_EQ(grid.data._length, 4U);
  EXPECT_EQ(grid.data._buffer[0], 0);
  EXPECT_EQ(grid.data._buffer[1], 100);
  EXPECT_EQ(grid.data._buffer[2], -1);
}

}  // namespace
}  // namespace cairn::ros
