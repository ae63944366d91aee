// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/overrun.hpp"

#include <gtest/gtest.h>

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

TEST(OverrunPolicy, ASoftOverrunIsNotedAHardOneSkipsARelease) {
  OverrunPolicy policy(5ms, 10ms);
  EXPECT_FALSE(policy.tick(5ms, true).soft);
  const auto soft = policy.tick(6ms, true);
  EXPECT_TRUE(soft.soft && !soft.hard && soft.skip == 0);
  const auto hard = policy.tick(11ms, true);
  EXPECT_TRUE(hard.soft && hard.hard && hard.skip == 1 && !policy.demoted());
}

TEST(OverrunPolicy, ThreeInARowDemoteUntilTenGoodTicksInARow) {
  OverrunPolicy policy(5ms, 10ms);
  for (int i = 0; i < 2; ++i) (void)policy.tick(11ms, true);
  (void)policy.tick(1ms, true);
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(policy.tick(11ms, true).newly_demoted) << "not in a row";
  EXPECT_TRUE(policy.tick(11ms, true).newly_demoted);
  EXPECT_FALSE(policy.tick(11ms, true).newly_demoted) << "once";
  for (int i = 0; i < 9; ++i) EXPECT_EQ(policy.tick(1ms, true).skip, 1U);
  for (int i = 0; i < 99; ++i) EXPECT_EQ(policy.tick(1ms, false).skip, 1U) << "an idle tick proves nothing";
  EXPECT_EQ(policy.tick(1ms, true).skip, 0U);
  EXPECT_FALSE(policy.demoted());
}

TEST(OverrunPolicy, WithoutBudgetsNothingIsAnOverrun) {
  OverrunPolicy policy(0ms, 0ms);
  const auto v = policy.tick(100s, true);
  EXPECT_TRUE(!v.soft && !v.hard && v.skip == 0);
}

}  // namespace
}  // namespace cairn::scheduler
