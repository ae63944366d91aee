// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/simulator/motion/route.hpp"

namespace cairn::simulator {
namespace {

constexpr DriveLimits kLimits;

struct Rates {
  double speed = 0, sideways = 0, yaw_rate = 0;
};

/// Between knots i and i+1.
Rates rates(const Trajectory& trajectory, std::size_t i) {
  const double dt = to_seconds(Trajectory::kKnotPeriod);
  const Vector6 &a = trajectory.knots()[i], &b = trajectory.knots()[i + 1];
  const Eigen::Vector2d step = (b - a).head<2>() / dt;
  const double heading = 0.5 * (a[5] + b[5]);
  return {step.dot(Eigen::Vector2d(std::cos(heading), std::sin(heading))),
          step.dot(Eigen::Vector2d(-std::sin(heading), std::cos(heading))), (b[5] - a[5]) / dt};
}

void expect_within_limits(const Trajectory& trajectory) {
  const double dt = to_seconds(Trajectory::kKnotPeriod);
  Rates before;
  for (std::size_t i = 0; i + 1 < trajectory.knots().size(); ++i) {
    const Rates now = rates(trajectory, i);
    ASSERT_LE(std::abs(now.speed), kLimits.speed + 1e-9) << i;
    ASSERT_LE(std::abs(now.yaw_rate), kLimits.yaw_rate + 1e-9) << i;
    ASSERT_LE(std::abs(now.sideways), 1e-3) << i;
    ASSERT_LE(std::abs(now.speed - before.speed) / dt, kLimits.acceleration + 1e-6) << i;
    ASSERT_LE(std::abs(now.yaw_rate - before.yaw_rate) / dt, kLimits.yaw_acceleration + 1e-6) << i;
    before = now;
  }
}

class DriveInEveryScene : public ::testing::TestWithParam<std::string> {};

TEST_P(DriveInEveryScene, RobotsKeepTheirLimitsAndTouchNothing) {
  const World world = *make_world(GetParam());
  const FloorPlan plan(world);
  const auto paths = RoutePlanner(world, plan, 1).plan(2, 92.0);
  ASSERT_TRUE(paths);
  for (const Path& path : *paths) {
    const Trajectory trajectory = drive(world, plan, path, Time{}, std::chrono::seconds(60), kLimits, 1);
    expect_within_limits(trajectory);
    EXPECT_GT(trajectory.length(), 30.0);
    EXPECT_GE(trajectory.end(), Time(std::chrono::seconds(60)));
    for (const Vector6& pose : trajectory.knots()) {
      ASSERT_GT(plan.body_clearance(pose[0], pose[1], pose[5]), 0.03) << pose.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DriveInEveryScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& test) { return test.param; });

TEST(Drive, RestsForASecond) {
  const World world = *make_world("corridor");
  const FloorPlan plan(world);
  const Path path = (*RoutePlanner(world, plan, 1).plan(1, 20.0))[0];
  const Trajectory trajectory = drive(world, plan, path, Time{}, std::chrono::seconds(5), kLimits, 1);
  for (std::size_t i = 0; i <= 100; ++i) EXPECT_EQ(trajectory.knots()[i], trajectory.knots()[0]);
  EXPECT_GT(trajectory.length(), 0.5);
}

TEST(Drive, ComesToRestAtTheEndOfThePath) {
  const World world = *make_world("corridor");
  const FloorPlan plan(world);
  const Path path = smooth(plan, *find_path(plan, world.places[0], world.places[5]));
  const Trajectory trajectory = drive(world, plan, path, Time{}, std::chrono::seconds(40), kLimits, 1);
  const auto& knots = trajectory.knots();
  EXPECT_EQ(knots[knots.size() - 2], knots.back());
  EXPECT_LT((knots.back().head<2>() - path.back()).norm(), 0.5);
}

TEST(Drive, StandsOnAPlaneAsThePlaneLies) {
  World world;
  constexpr double kRiseX = 0.1, kRiseY = -0.05;
  world.ground = [](double x, double y) { return 1.0 + kRiseX * x + kRiseY * y; };
  for (const double yaw : {0.0, 0.7, 2.0, -2.5}) {
    const SE3 T = SE3::from_xyz_rpy(on_ground(world, 3, 4, yaw));
    EXPECT_NEAR(T.translation().z(), 1.0 + 0.3 - 0.2 + Body::kBaseHeight, 1e-9);
    const Eigen::Vector3d normal = Eigen::Vector3d(-kRiseX, -kRiseY, 1).normalized();
    EXPECT_GT((T.rotation() * Eigen::Vector3d::UnitZ()).dot(normal), std::cos(1e-3)) << yaw;
  }
}

}  // namespace
}  // namespace cairn::simulator
