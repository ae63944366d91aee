// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/flight.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {
namespace {

constexpr Time kTakeOff = Time(std::chrono::seconds(10));

class FlightOfEveryScene : public ::testing::TestWithParam<std::string> {};

TEST_P(FlightOfEveryScene, StaysInFreeAirAndInItsLimits) {
  const World world = *make_world(GetParam());
  const FloorPlan plan = flight_plan(world);
  const auto paths = RoutePlanner(world, plan, 3).plan(1, 70);
  ASSERT_TRUE(paths) << to_string(paths.error());
  const FlightLimits limits;
  const Trajectory flight = fly(world, plan, (*paths)[0], kTakeOff, std::chrono::seconds(25), limits, 3);
  const auto tracer = Tracer::build(world.mesh);
  double lowest = 1e9, highest = -1e9, tilt = 0;
  for (std::size_t i = 1; i + 1 < flight.knots().size(); ++i) {
    const Vector6 &before = flight.knots()[i - 1], &now = flight.knots()[i], &after = flight.knots()[i + 1];
    const double above = now[2] - world.ground(now[0], now[1]);
    lowest = std::min(lowest, above);
    highest = std::max(highest, above);
    tilt = std::max(tilt, std::hypot(now[3], now[4]));
    EXPECT_LT((after - before).head<2>().norm() / 0.02, limits.level.speed + 0.05);
    EXPECT_LT(std::abs(after[3] - before[3]) / 0.02, 3.0) << "rad/s of roll";
    EXPECT_LT(std::abs(after[4] - before[4]) / 0.02, 3.0);
    if (i % 5 != 0) continue;
    for (int k = 0; k < 16; ++k) {  // nothing within reach of the rotors
      const double a = k * 0.3927;
      const Eigen::Vector3d direction(std::cos(a), std::sin(a), 0.1 * (k % 3 - 1));
      EXPECT_FALSE(tracer->blocked(now.head<3>(), direction.normalized(), 0.28)) << now.transpose();
    }
  }
  EXPECT_GE(lowest, world.flight.low - 1e-9);
  EXPECT_LE(highest, world.flight.high + 1e-9);
  EXPECT_GT(highest - lowest, 0.2);
  EXPECT_GT(tilt, 0.02);
  EXPECT_LT(tilt, 0.5);
  EXPECT_GT(flight.length(), 12);
}

INSTANTIATE_TEST_SUITE_P(Scenes, FlightOfEveryScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& test) { return test.param; });

TEST(Flight, LeansForwardToGoFaster) {
  const World world = *make_world("street");
  const FloorPlan plan = flight_plan(world);
  const Path straight = smooth(plan, *find_path(plan, {20, 35.3}, {60, 35.3}));
  const Trajectory flight = fly(world, plan, straight, kTakeOff, std::chrono::seconds(8), {}, 1);
  EXPECT_GT(flight.xyz_rpy(kTakeOff + std::chrono::milliseconds(1700))[4], 0.05) << "nose down (REP-103)";
}

}  // namespace
}  // namespace cairn::simulator
