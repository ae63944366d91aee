// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/clock_offset.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::peers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ClockOffset, IsFoundWithinItsBoundOnAnUnevenLink) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    ClockOffset clock;
    const Duration offset = seconds(-7200) + milliseconds(random() % 5000);
    for (int i = 0; i < 30; ++i) {
      const Time sent{seconds(i)};
      const Duration there = milliseconds(5 + random() % 200), held = milliseconds(random() % 900),
                     back = milliseconds(5 + random() % 200);
      EXPECT_TRUE(clock.add(sent, held, sent + there + held + offset, sent + there + held + back));
    }
    const auto estimate = clock.estimate();
    ASSERT_TRUE(estimate.has_value());
    EXPECT_LE(std::chrono::abs(estimate->offset - offset), estimate->bound);
    EXPECT_LE(estimate->bound, milliseconds(150));
    EXPECT_LE(*clock.longest_way(), milliseconds(410));
  }
}

TEST(ClockOffset, AnAnswerBeforeTheQuestionTeachesNothing) {
  ClockOffset clock;
  EXPECT_FALSE(clock.add(Time{seconds(5)}, milliseconds(200), Time{seconds(9)}, Time{seconds(5)} + milliseconds(100)));
  EXPECT_FALSE(clock.add(Time{seconds(5)}, milliseconds(-1), Time{seconds(9)}, Time{seconds(6)}));
  EXPECT_FALSE(clock.estimate().has_value());
  EXPECT_FALSE(clock.longest_way().has_value());
}

}  // namespace
}  // namespace cairn::peers
