// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/view/costmap.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/onboard/client/view/painted_map.hpp"

namespace cairn::client {
namespace {

/// A floor at z = 0 with free space above, 8 m by 8 m around the robot, whose base is 0.15 m above it.
class CostmapTest : public ::testing::Test {
 protected:
  CostmapTest() {
    map_.box({-4, -4, -0.1}, {4, 4, 0}, true);
    map_.box({-4, -4, 0}, {4, 4, 1.5}, false);
  }
  Costmap make() {
    const PlannerView view(map_.mirror(), nullptr, std::nullopt);
    return make_costmap(view, SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.05, 0.05, 0.15)), {.size_m = 10});
  }
  static std::uint8_t at(const Costmap& map, double x, double y) {
    return map.at(static_cast<int>(std::floor((x - map.x_m) / map.resolution_m)),
                  static_cast<int>(std::floor((y - map.y_m) / map.resolution_m)));
  }
  test::PaintedMap map_;
};

TEST_F(CostmapTest, AnEmptyFloorIsFreeAndTheRestUnknown) {
  const Costmap map = make();
  EXPECT_EQ(map.cells, 100);
  EXPECT_EQ(at(map, 3.5, 3.5), Costmap::kFree);
  EXPECT_EQ(at(map, 4.5, 0.05), Costmap::kUnknown);
}

TEST_F(CostmapTest, AWallIsLethalAndHidesWhatIsBehind) {
  map_.box({2, -4, 0}, {2.1, 4, 1.5}, true);
  const Costmap map = make();
  EXPECT_EQ(at(map, 2.05, 0), Costmap::kLethal);
  EXPECT_EQ(at(map, 1.75, 0), Costmap::kInscribed);
  EXPECT_GT(at(map, 1.55, 0), Costmap::kFree);
  EXPECT_LT(at(map, 1.45, 0), at(map, 1.55, 0)) << "the cost falls with the distance";
  EXPECT_EQ(at(map, 1.05, 0), Costmap::kFree);
  EXPECT_EQ(at(map, 3, 0), Costmap::kUnknown) << "no way leads there";
}

TEST_F(CostmapTest, AStepThatTheRobotClimbsIsGround) {
  map_.box({2, -4, 0}, {4, 4, 0.1}, true);
  const Costmap map = make();
  EXPECT_EQ(at(map, 3, 0), Costmap::kFree);
  map_.box({2, -4, 0}, {4, 4, 0.4}, true);
  EXPECT_EQ(at(make(), 2.05, 0), Costmap::kLethal) << "a higher one is a wall";
}

TEST_F(CostmapTest, ARampIsFollowed) {
  for (int i = 0; i < 10; ++i) map_.box({1 + 0.2 * i, -4, 0}, {4, 4, 0.1 * i}, true);
  map_.box({3, -4, 0.9}, {4, 4, 2.5}, false);
  EXPECT_EQ(at(make(), 3.5, 0), Costmap::kFree);
}

TEST_F(CostmapTest, UnderATableTheRobotsHeightDecides) {
  map_.box({2, -1, 0.6}, {3, 1, 0.7}, true);
  EXPECT_EQ(at(make(), 2.05, 0), Costmap::kLethal);
  map_.box({2, -1, 0.6}, {3, 1, 0.7}, false);
  map_.box({2, -1, 1.2}, {3, 1, 1.3}, true);
  EXPECT_EQ(at(make(), 2.5, 0), Costmap::kFree);
}

TEST_F(CostmapTest, ADropIsLethal) {
  map_.box({2, -4, -1}, {4, 4, 0}, false);
  const Costmap map = make();
  EXPECT_EQ(at(map, 2.05, 0), Costmap::kLethal);
  EXPECT_EQ(at(map, 3, 0), Costmap::kUnknown);
}

TEST_F(CostmapTest, TheRingThatTheLidarDoesNotSeeIsCrossed) {
  test::PaintedMap map;
  map.box({-4, -4, 0}, {4, 4, 1.5}, false);
  map.box({-4, -4, -0.1}, {-1, 4, 0}, true).box({1, -4, -0.1}, {4, 4, 0}, true);
  const PlannerView view(map.mirror(), nullptr, std::nullopt);
  const Costmap costs = make_costmap(view, SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.05, 0.05, 0.15)));
  EXPECT_EQ(at(costs, 2, 0), Costmap::kFree);
}

TEST_F(CostmapTest, TheGridOfRosHasItsOwnNumbers) {
  map_.box({2, -4, 0}, {2.1, 4, 1.5}, true);
  const auto grid = make().occupancy_grid();
  EXPECT_EQ(*std::ranges::max_element(grid), 100);
  EXPECT_EQ(*std::ranges::min_element(grid), -1);
}

}  // namespace
}  // namespace cairn::client
