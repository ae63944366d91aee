// SPDX-License-Identifier: Apache-2.0
#include "hal/clock.hpp"

#include <gtest/gtest.h>

#include "hal/budget.hpp"

namespace cairn {
namespace {

TEST(Clock, TheLiveClockNeverRunsBackwards) {
  const LiveClock clock;
  Time last = clock.now();
  for (int i = 0; i < 1000; ++i) {
    const Time now = clock.now();
    EXPECT_GE(now, last);
    last = now;
  }
}

TEST(Clock, TheVirtualClockOnlyAdvances) {
  VirtualClock clock;
  clock.advance_to(Time{Duration{100}});
  clock.advance_to(Time{Duration{50}});
  EXPECT_EQ(clock.now(), Time{Duration{100}});
}

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(1.0000000004).count(), 1'000'000'000);
  EXPECT_EQ(from_seconds(-0.0000000016).count(), -2);
  EXPECT_DOUBLE_EQ(to_seconds(from_seconds(12.25)), 12.25);
}

TEST(Budget, GrantsTheMandatoryStepAndThenUpToTheLimit) {
  Budget none = Budget::steps(0);
  EXPECT_TRUE(none.one_more()) << "a stage always gives one result";
  EXPECT_FALSE(none.one_more());
  Budget three = Budget::steps(3);
  int steps = 0;
  while (three.one_more()) ++steps;
  EXPECT_EQ(steps, 3);
  EXPECT_EQ(three.spent(), 3);
}

TEST(Budget, ADeadlineEndsItAndVirtualTimeDoesNotRunWhileAStageWorks) {
  VirtualClock clock;
  clock.advance_to(Time{Duration{10}});
  Budget budget = Budget::until(Time{Duration{20}}, clock, 100);
  EXPECT_TRUE(budget.one_more());
  EXPECT_TRUE(budget.one_more());
  clock.advance_to(Time{Duration{20}});
  EXPECT_FALSE(budget.one_more());
}

}  // namespace
}  // namespace cairn
