// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

class Routes : public ::testing::Test {
 protected:
  World world_ = *make_world("lobby");
  FloorPlan plan_{world_};
};

TEST_F(Routes, AreLongEnoughAndClearOfObstacles) {
  const auto paths = RoutePlanner(world_, plan_, 4).plan(3, 60.0);
  ASSERT_TRUE(paths);
  ASSERT_EQ(paths->size(), 3u);
  for (const Path& path : *paths) {
    EXPECT_GE(path_length(path), 60.0);
    for (const Eigen::Vector2d& p : path) EXPECT_GE(plan_.clearance(p), kPassable - FloorPlan::kCell);
  }
}

TEST_F(Routes, StartApartAndMeet) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto paths = RoutePlanner(world_, plan_, seed).plan(2, 60.0);
    ASSERT_TRUE(paths);
    EXPECT_GE(((*paths)[0].front() - (*paths)[1].front()).norm(), 3.0);
    int shared = 0;
    for (const Eigen::Vector2d& p : (*paths)[0]) {
      for (const Eigen::Vector2d& q : (*paths)[1]) {
        if ((p - q).norm() < 0.5) {
          ++shared;
          break;
        }
      }
    }
    EXPECT_GT(shared, 10);
  }
}

TEST_F(Routes, DoNotDependOnHowManyRobotsThereAre) {
  const RoutePlanner planner(world_, plan_, 9);
  EXPECT_EQ((*planner.plan(1, 30.0))[0], (*planner.plan(3, 30.0))[0]);
}

TEST_F(Routes, DependOnTheSeed) {
  EXPECT_NE((*RoutePlanner(world_, plan_, 1).plan(1, 30.0))[0], (*RoutePlanner(world_, plan_, 2).plan(1, 30.0))[0]);
}

TEST_F(Routes, SayWhenThereAreTooManyRobots) {
  const auto paths = RoutePlanner(world_, plan_, 1).plan(100, 30.0);
  ASSERT_FALSE(paths);
  EXPECT_EQ(paths.error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::simulator
