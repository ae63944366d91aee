// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/rate_window.hpp"

#include <gtest/gtest.h>

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;

int taken_of(RateWindow& window, Time from, int datagrams, Duration apart) {
  int taken = 0;
  for (int i = 0; i < datagrams; ++i) taken += window.take(from + i * apart) ? 1 : 0;
  return taken;
}

TEST(RateWindow, AFloodGetsAWindowsShareAndNoMore) {
  RateWindow window(100);
  EXPECT_EQ(taken_of(window, Time{5s}, 1000, 99us), 10);
  EXPECT_EQ(taken_of(window, Time{5s + 100ms}, 1000, 99us), 10) << "the next window";
  EXPECT_EQ(taken_of(window, Time{60s}, 1000, 1ms), 100) << "ten windows";
}

TEST(RateWindow, WhatComesAtTheRateIsTaken) {
  RateWindow window(100);
  EXPECT_EQ(taken_of(window, Time{5s}, 1000, 10ms), 1000);
}

TEST(RateWindow, AStampOfThePastBeginsAWindow) {
  RateWindow window(100);
  EXPECT_EQ(taken_of(window, Time{5s}, 20, 0s), 10);
  EXPECT_EQ(taken_of(window, Time{4s}, 20, 0s), 10);
}

}  // namespace
}  // namespace cairn::velodyne
