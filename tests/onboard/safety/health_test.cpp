// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/health.hpp"

#include <gtest/gtest.h>

namespace cairn::safety {
namespace {

using namespace std::chrono_literals;

TEST(Supervisor, ATaskHangsWhenItsLimitHasPassedAndNotBefore) {
  RelaxedCounter a, b;
  Supervisor supervisor({{"a", 100ms, &a}, {"b", 300ms, &b}});
  Time now{};
  EXPECT_FALSE(supervisor.step(now));
  for (int i = 0; i < 100; ++i) {
    ++a, ++b;
    EXPECT_FALSE(supervisor.step(now += 50ms));
  }
  for (int i = 0; i < 2; ++i) {
    ++a;
    EXPECT_FALSE(supervisor.step(now += 100ms));
  }
  ++a;
  EXPECT_FALSE(supervisor.step(now += 100ms)) << "300 ms is its limit";
  ++a;
  const auto found = supervisor.step(now += 1ms);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pulse, 1U);
  EXPECT_EQ(found->silent, 301ms);
  ++b;
  EXPECT_FALSE(supervisor.step(now += 1ms));
}

TEST(Supervisor, TheOneFarthestBeyondItsLimitIsAccused) {
  RelaxedCounter a, b;
  Supervisor supervisor({{"a", 300ms, &a}, {"b", 100ms, &b}});
  Time now{};
  std::optional<Supervisor::Finding> found;
  for (int i = 0; i < 10; ++i) found = supervisor.step(now += 100ms);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pulse, 1U);
}

TEST(Supervisor, AMachineThatStoodAccusesNobody) {
  RelaxedCounter a;
  Supervisor supervisor({{"a", 100ms, &a}});
  supervisor.step(Time{1s});
  EXPECT_FALSE(supervisor.step(Time{60s}));
  EXPECT_FALSE(supervisor.step(Time{60s + 100ms}));
  EXPECT_TRUE(supervisor.step(Time{60s + 101ms}));
}

}  // namespace
}  // namespace cairn::safety
