// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/style.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/scenes/make_world.hpp"

namespace cairn::simulator {
namespace {

/// The largest rates of a trajectory, over 20 ms.
struct Extremes {
  double speed = 0, braking = 0, yaw_rate = 0, yaw_acceleration = 0, tilt = 0, lift = 0;
};

Extremes extremes(const Trajectory& trajectory) {
  constexpr double kSpan_s = 0.02;
  const auto& knots = trajectory.knots();
  Extremes out;
  double speed_before = 0, rate_before = 0;
  for (std::size_t i = 1; i + 1 < knots.size(); i += 2) {
    const Vector6 rate = (knots[i + 1] - knots[i - 1]) / kSpan_s;
    const double speed = rate.head<2>().norm();
    out.speed = std::max(out.speed, speed);
    out.braking = std::max(out.braking, (speed_before - speed) / kSpan_s);
    out.yaw_rate = std::max(out.yaw_rate, std::abs(rate[5]));
    out.yaw_acceleration = std::max(out.yaw_acceleration, std::abs(rate[5] - rate_before) / kSpan_s);
    out.tilt = std::max({out.tilt, std::abs(knots[i][3]), std::abs(knots[i][4])});
    out.lift = std::max(out.lift, knots[i][2] - knots[0][2]);
    speed_before = speed;
    rate_before = rate[5];
  }
  return out;
}

Trajectory moved(Motion motion, std::uint64_t seed = 1) {
  static const World world = *make_world("lobby");
  static const FloorPlan plan(world);
  const MotionStyle style = style_of(motion);
  const Path path = (*RoutePlanner(world, plan, seed).plan(1, 130.0))[0];
  const Trajectory smooth = drive(world, plan, path, Time{}, std::chrono::seconds(40), style.limits, seed, style.stops);
  return shaken(smooth, style, seed);
}

TEST(MotionStyle, EveryMotionHasAName) {
  for (const Motion motion : {Motion::kGentle, Motion::kBrisk, Motion::kAggressive, Motion::kHandheld})
    EXPECT_EQ(motion_of(to_string(motion)), motion);
}

TEST(MotionStyle, AGentleRobotIsNotShaken) {
  const Trajectory gentle = moved(Motion::kGentle);
  const Extremes e = extremes(gentle);
  EXPECT_LE(e.speed, 1.5);
  EXPECT_LE(e.yaw_rate, 1.0);
  EXPECT_LT(e.tilt, 1e-9);
}

TEST(MotionStyle, ABriskOneTurnsAt90DegreesPerSecond) {
  const Extremes e = extremes(moved(Motion::kBrisk));
  EXPECT_NEAR(e.yaw_rate, 1.57, 0.02);
  EXPECT_LE(e.speed, 2.0);
  EXPECT_GT(e.tilt, 0.005);
  EXPECT_LT(e.tilt, 0.03);
}

TEST(MotionStyle, AnAggressiveOneTurnsAt120DegreesPerSecondWithinATenthAndStopsAtOnce) {
  const Extremes e = extremes(moved(Motion::kAggressive));
  EXPECT_NEAR(e.yaw_rate, 2.1, 0.02);
  EXPECT_GT(e.yaw_acceleration, 19.0);
  EXPECT_GT(e.speed, 2.2);
  EXPECT_LE(e.speed, 3.0);
  EXPECT_GT(e.braking, 5.0);
  EXPECT_GT(e.tilt, 0.03);
}

TEST(MotionStyle, AWalkingPersonCarriesItWhereAHandIs) {
  const Trajectory walk = moved(Motion::kHandheld);
  const Extremes e = extremes(walk);
  EXPECT_NEAR(walk.knots().front()[2] - moved(Motion::kGentle).knots().front()[2], 0.8, 1e-9);
  EXPECT_GT(e.lift, 0.02) << "with every step";
  EXPECT_GT(e.tilt, 0.15);
  EXPECT_LT(e.tilt, 0.4);
}

TEST(MotionStyle, TheSameSeedGivesTheSameBumpsAndAnotherOneOthers) {
  EXPECT_EQ(moved(Motion::kAggressive, 2).knots(), moved(Motion::kAggressive, 2).knots());
  EXPECT_NE(moved(Motion::kAggressive, 2).knots(), moved(Motion::kAggressive, 3).knots());
}

}  // namespace
}  // namespace cairn::simulator
