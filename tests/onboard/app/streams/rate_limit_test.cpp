// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/rate_limit.hpp"

#include <gtest/gtest.h>

namespace cairn::app {
namespace {

int times_due(double rate_hz, Duration step, int steps) {
  RateLimit limit(rate_hz);
  int due = 0;
  for (int i = 0; i < steps; ++i) due += limit.due(Time{std::chrono::seconds(5) + i * step}) ? 1 : 0;
  return due;
}

TEST(RateLimit, KeepsTheMeanRateOnAnyGrid) {
  EXPECT_EQ(times_due(200, std::chrono::microseconds(2500), 400), 200);
  EXPECT_NEAR(times_due(30, std::chrono::microseconds(2500), 400), 30, 1);
  EXPECT_NEAR(times_due(7, std::chrono::milliseconds(100), 100), 70, 1);
}

TEST(RateLimit, ZeroLetsEverythingThrough) { EXPECT_EQ(times_due(0, Duration{1}, 10), 10); }

TEST(RateLimit, MakesUpForNoPause) {
  RateLimit limit(10);
  EXPECT_TRUE(limit.due(Time{std::chrono::seconds(1)}));
  EXPECT_TRUE(limit.due(Time{std::chrono::seconds(9)}));
  EXPECT_FALSE(limit.due(Time{std::chrono::seconds(9)}));
}

}  // namespace
}  // namespace cairn::app
