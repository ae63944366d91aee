// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/overload.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace cairn::safety {
namespace {

using namespace std::chrono_literals;

constexpr Load kHeavy{1.5, 1.0}, kLight{0.3, 0.0}, kBetween{0.75, 0.2};

/// A controller stepped at 10 Hz.
struct Ticked {
  Shed operator()(const Load& load) { return controller.step(now += 100ms, load); }
  OverloadController controller{OverloadConfig{}};
  Time now{5s};
};

TEST(Overload, ShedsInItsOrderOneLevelAtATime) {
  Ticked tick;
  std::vector<Shed> levels;
  for (int i = 0; i < 12; ++i) levels.push_back(tick(kHeavy));
  using enum Shed;
  const std::vector<Shed> expected{kNothing,        kPeerTiles,      kPeerTiles,      kSemantics,
                                   kSemantics,      kMapDensity,     kMapDensity,     kScanDecimation,
                                   kScanDecimation, kScanDecimation, kScanDecimation, kScanDecimation};
  EXPECT_EQ(levels, expected);
}

TEST(Overload, EverythingIsBackWithinASecondOfTheLoadsEnd) {
  for (const Duration period : {Duration{10ms}, Duration{50ms}, Duration{100ms}}) {
    for (const double relieved_ms : {50.0, 130.0, 200.0}) {
      OverloadConfig config;
      config.relieved_ms = relieved_ms;
      OverloadController controller(config);
      Time now{};
      for (int i = 0; i < 100; ++i) controller.step(now += period, kHeavy);
      const Time end = now;
      while (controller.level() != Shed::kNothing) controller.step(now += period, kLight);
      EXPECT_LE(now - end, 1s) << relieved_ms;
    }
  }
}

TEST(Overload, ASingleSpikeShedsNothing) {
  Ticked tick;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(tick(i % 2 == 0 ? kHeavy : kLight), Shed::kNothing);
}

TEST(Overload, BetweenTheThresholdsNothingChanges) {
  Ticked tick;
  tick(kHeavy), tick(kHeavy), tick(kHeavy);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(tick(kBetween), Shed::kPeerTiles);
}

TEST(Overload, TheLevelFollowsTheLoadWithoutHunting) {
  // Whatever the demand: where a level saves less than 1 − low/high, the level settles and stays.
  for (double demand = 0.2; demand < 3.0; demand += 0.01) {
    Ticked tick;
    int changes_late = 0;
    Shed last = Shed::kNothing;
    for (int i = 0; i < 400; ++i) {
      const double utilisation = demand * std::pow(0.7, static_cast<double>(tick.controller.level()));
      const Shed level = tick({utilisation, 0});
      changes_late += i > 50 && level != last ? 1 : 0;
      last = level;
    }
    EXPECT_EQ(changes_late, 0) << demand;
    EXPECT_TRUE(demand >= 0.9 || last == Shed::kNothing) << demand;
  }
}

TEST(Overload, LevelsMoveByOneAndOnlyTheWayTheLoadPoints) {
  std::mt19937_64 random(3);
  Ticked tick;
  for (int i = 0; i < 100'000; ++i) {
    const Load load{static_cast<double>(random() % 200) / 100, static_cast<double>(random() % 100) / 100};
    const int before = static_cast<int>(tick.controller.level());
    const int change = static_cast<int>(tick(load)) - before;
    EXPECT_LE(std::abs(change), 1);
    const bool heavy = load.utilisation >= 0.9 || load.queue_fill >= 0.9;
    const bool light = load.utilisation < 0.6 && load.queue_fill < 0.6;
    EXPECT_TRUE(change <= 0 || heavy);
    EXPECT_TRUE(change >= 0 || light);
  }
}

TEST(Overload, WhatIsNoNumberCountsAsLoad) {
  Ticked tick;
  tick({std::nan(""), 0});
  EXPECT_EQ(tick({std::nan(""), 0}), Shed::kPeerTiles);
}

TEST(Overload, EachLevelLeavesUndoneWhatTheOneBeforeDidAndMore) {
  ShedPlan before = plan_of(Shed::kNothing);
  EXPECT_TRUE(before.point_stride == 1 && before.scan_stride == 1);
  for (int i = 1; i < kShedLevels; ++i) {
    const ShedPlan plan = plan_of(static_cast<Shed>(i));
    EXPECT_GE(plan.point_stride, before.point_stride);
    EXPECT_GE(plan.scan_stride, before.scan_stride);
    before = plan;
  }
  EXPECT_GT(before.scan_stride, 1);
}

TEST(Overload, ALevelIsNamedOnlyWhereItLeavesSomethingOut) {
  const ShedPlan all = plan_of(Shed::kNothing);
  for (int i = 0; i < kShedLevels; ++i) {
    const auto level = static_cast<Shed>(i);
    const ShedPlan plan = plan_of(level);
    const bool less = plan.point_stride > all.point_stride || plan.scan_stride > all.scan_stride;
    EXPECT_EQ(in_force(level, {}), less ? level : Shed::kNothing) << to_string(level);
    EXPECT_EQ(in_force(level, {.pictures = true}), less || level == Shed::kSemantics ? level : Shed::kNothing);
    EXPECT_EQ(in_force(level, {.peers = true, .pictures = true}), level);
  }
  EXPECT_EQ(in_force(Shed::kSemantics, {.peers = true}), Shed::kPeerTiles) << "it includes the one before";
}

TEST(Overload, ItsBoundsKeepTheSecond) {
  OverloadConfig config;
  config::Section section;
  declare(section, config);
  EXPECT_TRUE(config::parse("relieved_ms: 200\n", "f", section));
  EXPECT_FALSE(config::parse("relieved_ms: 201\n", "f", section));
}

}  // namespace
}  // namespace cairn::safety
