// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/screens.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/scenes/make_world.hpp"

namespace cairn::simulator {
namespace {

class ScreensInScenes : public ::testing::TestWithParam<std::tuple<const char*, Screens>> {};

TEST_P(ScreensInScenes, StandWhereRobotsCanPassAndAreTheSameEveryTime) {
  const World before = *make_world(std::get<0>(GetParam()));
  World world = before;
  EXPECT_GE(add_screens(world, std::get<1>(GetParam())), 6U);
  const std::size_t old = before.mesh.triangles().size();
  ASSERT_GT(world.mesh.triangles().size(), old);
  World again = before;
  add_screens(again, std::get<1>(GetParam()));
  ASSERT_EQ(again.mesh.triangles().size(), world.mesh.triangles().size());
  const FloorPlan floor(before), plan(world);
  for (std::size_t i = old; i < world.mesh.triangles().size(); ++i) {
    const Eigen::Vector2d at = world.mesh.triangles()[i].a.head<2>().cast<double>();
    EXPECT_GT(floor.clearance(at), 0.9);
    EXPECT_LT(plan.clearance(at), 0.1) << "an obstacle";
  }
  const std::size_t reached = RoutePlanner(before, floor, 1).places().size();
  EXPECT_EQ(RoutePlanner(world, plan, 1).places().size(), reached);
}

TEST(Screens, NoneChangesNothing) {
  World world = *make_world("lobby");
  const std::size_t before = world.mesh.triangles().size();
  EXPECT_EQ(add_screens(world, screens_of("none")), 0U);
  EXPECT_EQ(world.mesh.triangles().size(), before);
  EXPECT_EQ(screens_of("glass"), Screens::kGlass);
  EXPECT_EQ(screens_of("fence"), Screens::kFence);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ScreensInScenes,
                         ::testing::Values(std::tuple("lobby", Screens::kGlass), std::tuple("street", Screens::kFence),
                                           std::tuple("carpark", Screens::kGlass)));

}  // namespace
}  // namespace cairn::simulator
