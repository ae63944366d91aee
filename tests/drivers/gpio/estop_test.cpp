// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/estop.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/support/allocation_count.hpp"

namespace cairn::gpio {
namespace {

using namespace std::chrono_literals;

class EStopTest : public testing::Test {
 protected:
  void read(bool closed, Duration duration) {
    for (const Time end = now + duration; now < end;) {
      now += 1ms;
      stop.level(now, closed);
      stopped = stop.stopped(now);
    }
  }
  void arm() {
    read(true, 600ms);
    ASSERT_TRUE(stop.rearm(now));
    ASSERT_FALSE(stop.stopped(now));
  }
  EStop stop{Config{}};
  Time now{1s};
  bool stopped = true;
};

TEST_F(EStopTest, ARefusalAllocatesNothingAndSaysWhy) {
  const auto refused = [this](std::string_view why) {
    const std::size_t before = support::allocation_count();
    const auto done = stop.rearm(now);
    EXPECT_EQ(support::allocation_count() - before, 0U) << why;
    EXPECT_NE(to_string(done.error()).find(why), std::string::npos) << to_string(done.error());
  };
  refused("not read in time");
  read(false, 10ms);
  refused("release the button");
  read(true, 100ms);
  refused("not been closed for long enough");
}

TEST_F(EStopTest, StartsStopped) {
  EXPECT_TRUE(stop.stopped(now));
  EXPECT_FALSE(stop.rearm(now));
  read(true, 600ms);
  EXPECT_TRUE(stopped) << "until somebody arms it";
  EXPECT_TRUE(stop.rearm(now));
  EXPECT_FALSE(stop.stopped(now));
}

TEST_F(EStopTest, OneOpeningEdgeStops) {
  arm();
  stop.edge(now, false, 0);
  EXPECT_TRUE(stop.stopped(now));
  EXPECT_EQ(stop.cause(), EStop::Cause::kOpened);
}

TEST_F(EStopTest, AnOpenLevelWithoutEdgeStops) {
  arm();
  read(false, 1ms);
  EXPECT_TRUE(stopped);
  EXPECT_EQ(stop.counters().unseen_edges, 2U) << "closing at the start, opening now";
}

TEST_F(EStopTest, APressBetweenTwoReadingsIsNotMissed) {
  arm();
  stop.edge(now + 200us, false, 1);
  stop.edge(now + 400us, true, 2);
  read(true, 50ms);
  EXPECT_TRUE(stopped);
}

TEST_F(EStopTest, ReleaseWaitsUntilTheContactRests) {
  arm();
  stop.edge(now, false, 1);
  for (std::uint32_t i = 2; i < 20; i += 2) {  // bounces for 9 ms
    now += 1ms;
    stop.edge(now, true, i);
    EXPECT_FALSE(stop.released(now));
    stop.edge(now, false, i + 1);
  }
  now += 1ms;
  stop.edge(now, true, 20);
  read(true, 4ms);
  EXPECT_FALSE(stop.released(now));
  read(true, 1ms);
  EXPECT_TRUE(stop.released(now));
  EXPECT_FALSE(stop.rearm(now)) << "half a second";
  read(true, 495ms);
  EXPECT_TRUE(stop.rearm(now));
}

TEST_F(EStopTest, LostEdgesStop) {
  arm();
  stop.edge(now, true, 10);
  EXPECT_FALSE(stop.stopped(now));
  stop.edge(now, true, 13);
  EXPECT_TRUE(stop.stopped(now));
  EXPECT_EQ(stop.cause(), EStop::Cause::kEdgesLost);
  EXPECT_EQ(stop.counters().edges_lost, 2U);
}

TEST_F(EStopTest, ASilentReaderAndALostLineStop) {
  arm();
  EXPECT_FALSE(stop.stopped(now + 100ms));
  EXPECT_TRUE(stop.stopped(now + 101ms));
  EXPECT_EQ(stop.cause(), EStop::Cause::kSilent);
  read(true, 600ms);
  ASSERT_TRUE(stop.rearm(now));
  stop.lost(now);
  EXPECT_TRUE(stop.stopped(now));
  EXPECT_EQ(stop.cause(), EStop::Cause::kLineLost);
}

/// Every sequence of eight readings and edges: once open was seen by any way, it stays stopped; else it never stops.
TEST_F(EStopTest, EverySequenceOfInputs) {
  for (int inputs = 0; inputs < 1 << 16; ++inputs) {
    EStop e{Config{}};
    Time t{1s};
    for (int i = 0; i <= 600; i += 50) e.level(t += 50ms, true);
    ASSERT_TRUE(e.rearm(t));
    bool opened = false;
    for (int i = 0; i < 8; ++i) {
      t += 1ms;
      const bool closed = (inputs >> 2 * i & 1) != 0, edge = (inputs >> (2 * i + 1) & 1) != 0;
      if (edge)
        e.edge(t, closed, 0);
      else
        e.level(t, closed);
      opened = opened || !closed;
      ASSERT_EQ(e.stopped(t), opened) << inputs << " " << i;
    }
    ASSERT_FALSE(opened && e.rearm(t).has_value());
  }
}

TEST_F(EStopTest, NeverMovesWithoutArmingAfterAStop) {
  std::mt19937 random(5);
  for (int run = 0; run < 200; ++run) {
    bool latched = true;
    for (int i = 0; i < 200; ++i) {
      now += std::chrono::microseconds(random() % 20000);
      const auto kind = random() % 20;
      if (kind < 12) {
        const bool closed = random() % 16 != 0;
        stop.level(now, closed);
        latched = latched || !closed;
      } else if (kind < 16) {
        const bool closed = random() % 3 != 0;
        stop.edge(now, closed, 0);
        latched = latched || !closed;
      } else if (kind == 16) {
        stop.lost(now);
        latched = true;
      } else if (stop.rearm(now)) {
        latched = false;
      }
      const bool is_stopped = stop.stopped(now);
      if (latched) {
        ASSERT_TRUE(is_stopped);
      }
      latched = is_stopped;
    }
  }
}

}  // namespace
}  // namespace cairn::gpio
