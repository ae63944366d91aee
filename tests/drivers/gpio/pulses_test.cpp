// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/pulses.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cairn::gpio {
namespace {

using namespace std::chrono_literals;

TEST(Trigger, PulsesAtItsRateWithItsLength) {
  Trigger trigger{Config{}};
  std::vector<Duration> rises, falls;
  for (Duration t = 0ms; t < 1s; t += 500us)
    if (const auto level = trigger.step(Time{t})) (*level ? rises : falls).push_back(t);
  ASSERT_EQ(rises.size(), 10U);
  for (std::size_t i = 0; i < rises.size(); ++i) {
    EXPECT_EQ(rises[i], 100ms * static_cast<int>(i));
    EXPECT_EQ(falls[i], rises[i] + 1ms);
  }
}

TEST(Trigger, LeavesOutMissedPulsesAndKeepsItsPhase) {
  Trigger trigger{Config{}};
  EXPECT_EQ(trigger.step(Time{0ms}), true);
  EXPECT_EQ(trigger.step(Time{350ms}), false);
  EXPECT_EQ(trigger.step(Time{351ms}), true);
  EXPECT_EQ(trigger.step(Time{352ms}), false);
  EXPECT_EQ(trigger.step(Time{399ms}), std::nullopt);
  EXPECT_EQ(trigger.step(Time{400ms}), true);
}

TEST(PpsMonitor, LocksOntoASecond) {
  PpsMonitor pps;
  EXPECT_EQ(pps.state(Time{0s}), PpsMonitor::State::kAbsent);
  for (int i = 1; i <= 4; ++i) EXPECT_EQ(pps.pulse(Time{1s * i + 100us * (i % 2)}), i > 1);
  EXPECT_EQ(pps.state(Time{5s}), PpsMonitor::State::kLocked);
  EXPECT_TRUE(pps.pulse(Time{6s})) << "one may be missing";
  EXPECT_EQ(pps.state(Time{8501ms}), PpsMonitor::State::kAbsent);
}

TEST(PpsMonitor, RefusesDisturbances) {
  PpsMonitor pps;
  for (int i = 1; i <= 5; ++i) pps.pulse(Time{1s * i});
  EXPECT_FALSE(pps.pulse(Time{5s + 300ms}));
  EXPECT_TRUE(pps.pulse(Time{6s}));
  EXPECT_EQ(pps.state(Time{6s}), PpsMonitor::State::kLocked);
  EXPECT_FALSE(pps.pulse(Time{7s + 2ms})) << "2000 ppm";
  EXPECT_EQ(pps.state(Time{7s + 2ms}), PpsMonitor::State::kUnlocked);
  EXPECT_EQ(pps.refused(), 2U);
}

}  // namespace
}  // namespace cairn::gpio
