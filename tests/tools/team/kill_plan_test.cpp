// SPDX-License-Identifier: Apache-2.0
#include "tools/team/kill_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cairn::team_run {
namespace {

using std::chrono::seconds;

TEST(KillPlan, KillsEachOncePerPartOfTheTimeInOrder) {
  constexpr std::size_t kTimes = 50;
  const auto plan = plan_kills(3, 4, kTimes, seconds(100));
  ASSERT_EQ(plan.size(), 4 * kTimes);
  EXPECT_TRUE(std::ranges::is_sorted(plan, {}, &Kill::after));
  for (Index robot = 0; robot < 4; ++robot) {
    std::size_t part = 0;
    for (const Kill& kill : plan) {
      if (kill.robot != robot) continue;
      EXPECT_GE(kill.after, seconds(2) * part);
      EXPECT_LT(kill.after, seconds(2) * (part + 1));
      ++part;
    }
    EXPECT_EQ(part, kTimes);
  }
}

TEST(KillPlan, IsThatOfItsSeed) {
  const auto moments = [](std::uint64_t seed) {
    std::vector<Duration> all;
    for (const Kill& kill : plan_kills(seed, 2, 10, seconds(10))) all.push_back(kill.after);
    return all;
  };
  EXPECT_EQ(moments(1), moments(1));
  EXPECT_NE(moments(1), moments(2));
  EXPECT_TRUE(plan_kills(1, 3, 0, seconds(10)).empty());
}

}  // namespace
}  // namespace cairn::team_run
