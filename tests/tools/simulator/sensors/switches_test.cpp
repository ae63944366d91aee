// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/switches.hpp"

#include <gtest/gtest.h>

#include "drivers/gpio/estop.hpp"
#include "drivers/gpio/pulses.hpp"

namespace cairn::simulator {
namespace {

using namespace std::chrono_literals;

constexpr Time kSwitchedOn = Time(10s);

TEST(Switches, TheEStopsStateMachineArmsAfterTheReleaseAndNeverStopsAgain) {
  const auto edges = line_edges(kSwitchedOn, kSwitchedOn + 5s, 15, 1ms, 4);
  gpio::EStop estop{gpio::Config{}};
  bool closed = false;
  std::size_t next = 0;
  std::optional<Time> armed;
  for (Time t = kSwitchedOn; t < kSwitchedOn + 5s; t += 5ms) {
    for (; next < edges.size() && edges[next].stamp <= t; ++next) {
      const LineEdge& e = edges[next];
      if (e.event.line != gpio::Line::kEStop) continue;
      closed = e.event.level;
      if (!e.event.sampled) estop.edge(e.stamp, e.event.level, e.event.sequence);
    }
    estop.level(t, closed);
    if (!armed && estop.rearm(t)) armed = t;
    EXPECT_EQ(estop.stopped(t), !armed) << to_seconds(t);
  }
  ASSERT_TRUE(armed);
  EXPECT_GE(*armed - kSwitchedOn, kEStopReleased + 500ms);
  EXPECT_LE(*armed - kSwitchedOn, kEStopReleased + 520ms);
  EXPECT_EQ(estop.counters().edges, 7U);
  EXPECT_EQ(estop.counters().edges_lost, 0U);
}

TEST(Switches, TheTriggerRisesAtEveryExposure) {
  std::uint64_t rises = 0, falls = 0;
  Time last{}, rose{};
  for (const LineEdge& e : line_edges(kSwitchedOn, kSwitchedOn + 2s, 15, 1ms, 4)) {
    EXPECT_GE(e.stamp, last);
    last = e.stamp;
    if (e.event.line != gpio::Line::kTrigger) continue;
    if (e.event.level) {
      EXPECT_EQ(e.stamp, exposure(kSwitchedOn, 15, rises++));
      rose = e.stamp;
    } else {
      EXPECT_EQ(e.stamp - rose, Duration(1ms));
      ++falls;
    }
    EXPECT_EQ(e.event.sequence, rises + falls);
  }
  EXPECT_EQ(rises, 30U);
  EXPECT_EQ(falls, 30U);
}

}  // namespace
}  // namespace cairn::simulator
