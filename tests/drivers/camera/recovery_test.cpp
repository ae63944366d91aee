// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/recovery.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cairn::camera {
namespace {

using namespace std::chrono_literals;
using Step = Recovery::Step;

constexpr Time kStart{1000s};

TEST(Recovery, ReadsUntilItIsSilent) {
  Recovery r(kStart, 700ms);
  EXPECT_EQ(r.step(kStart), Step::kRead);
  EXPECT_EQ(r.wake(), kStart + 700ms);
  EXPECT_EQ(r.step(kStart + 699ms), Step::kRead);
  EXPECT_EQ(r.step(kStart + 700ms), Step::kRestart);
  r.frame(kStart + 700ms);
  EXPECT_EQ(r.step(kStart + 1399ms), Step::kRead);
}

TEST(Recovery, RestartsThreeTimesThenOpensAgain) {
  Recovery r(kStart, 700ms);
  for (int i = 0; i < Recovery::kMaxRestarts; ++i) {
    r.broken(kStart);
    EXPECT_EQ(r.step(kStart), Step::kRestart) << i;
    r.restarted(kStart);
    EXPECT_EQ(r.step(kStart), Step::kRead) << i;
  }
  r.broken(kStart);
  EXPECT_EQ(r.step(kStart), Step::kReopen);
}

TEST(Recovery, AFrameForgivesRestarts) {
  Recovery r(kStart, 700ms);
  for (int i = 0; i < 100; ++i) {
    r.broken(kStart);
    ASSERT_EQ(r.step(kStart), Step::kRestart);
    r.restarted(kStart);
    r.frame(kStart);
  }
}

TEST(Recovery, BackOffDoublesFromATenthToTwoSeconds) {
  Recovery r(kStart, 700ms);
  std::vector<Duration> delays;
  Time now = kStart;
  for (int i = 0; i < 7; ++i) {
    r.lost(now);
    EXPECT_EQ(r.step(now), Step::kWait);
    EXPECT_EQ(r.step(r.wake() - 1ns), Step::kWait);
    EXPECT_EQ(r.step(r.wake()), Step::kReopen);
    delays.push_back(r.wake() - now);
    now = r.wake();
  }
  EXPECT_EQ(delays, (std::vector<Duration>{100ms, 200ms, 400ms, 800ms, 1600ms, 2s, 2s}));
}

TEST(Recovery, OnlyAFrameEndsTheBackOff) {
  Recovery r(kStart, 700ms);
  r.lost(kStart);
  r.reopened(kStart);
  EXPECT_EQ(r.step(kStart), Step::kRead);
  r.lost(kStart);
  EXPECT_EQ(r.wake(), kStart + 200ms);
  r.reopened(kStart);
  r.frame(kStart);
  r.lost(kStart);
  EXPECT_EQ(r.wake(), kStart + 100ms);
}

}  // namespace
}  // namespace cairn::camera
