// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/scale_watch.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::odometry {
namespace {

void drive(ScaleWatch& watch, double metres, double scale, double step_m = 0.1, double noise_m = 0) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 1);
  for (double way = 0; way < metres; way += step_m) watch.add(step_m, scale * step_m + noise_m * noise(random));
}

TEST(ScaleWatch, FindsAScaleThatIsWrongByAFifth) {
  for (const double scale : {0.8, 1.2}) {
    ScaleWatch watch;
    drive(watch, 2, scale);
    EXPECT_FALSE(watch.wrong()) << "too little way to say";
    EXPECT_FALSE(watch.scale());
    drive(watch, 5, scale);
    EXPECT_TRUE(watch.wrong());
    EXPECT_NEAR(watch.scale().value(), scale, 1e-9);
  }
}

TEST(ScaleWatch, ForgivesWornTyresAndNoise) {
  for (const double scale : {0.9, 1.0, 1.1}) {
    ScaleWatch watch;
    drive(watch, 100, scale, 0.1, 0.02);
    EXPECT_FALSE(watch.wrong()) << scale;
  }
}

TEST(ScaleWatch, SpinningWheelsAreWrongAndRightAgainLater) {
  ScaleWatch watch;
  drive(watch, 30, 1);
  drive(watch, 4, 0.1);
  EXPECT_TRUE(watch.wrong());
  drive(watch, 30, 1);
  EXPECT_FALSE(watch.wrong());
}

TEST(ScaleWatch, AWayBackCountsAsAWayAhead) {
  ScaleWatch watch;
  for (int i = 0; i < 100; ++i) watch.add(i % 2 == 0 ? 0.2 : -0.2, i % 2 == 0 ? 0.2 : -0.2);
  EXPECT_NEAR(watch.scale().value(), 1, 1e-9);
  for (int i = 0; i < 100; ++i) watch.add(0.2, -0.2);
  EXPECT_TRUE(watch.wrong()) << "they count backwards";
}

TEST(ScaleWatch, WheelsThatStandWhileTheBaseMovesAreWrong) {
  ScaleWatch watch;
  for (int i = 0; i < 100; ++i) watch.add(0, 0.2);
  EXPECT_TRUE(watch.wrong());
}

}  // namespace
}  // namespace cairn::odometry
