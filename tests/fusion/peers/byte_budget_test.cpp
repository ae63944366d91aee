// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/byte_budget.hpp"

#include <gtest/gtest.h>

namespace cairn::peers {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ByteBudget, GrowsWithTimeUpToASecond) {
  ByteBudget budget(1000);
  budget.refill(Time{seconds(50)});
  EXPECT_EQ(budget.left(), 0) << "the first call grants none";
  budget.refill(Time{seconds(50)} + milliseconds(100));
  EXPECT_DOUBLE_EQ(budget.left(), 100);
  budget.refill(Time{seconds(90)});
  EXPECT_DOUBLE_EQ(budget.left(), 1000);
}

TEST(ByteBudget, WhatWasSpentTooMuchIsPaidBack) {
  ByteBudget budget(1000);
  budget.refill(Time{});
  budget.spend(300);
  EXPECT_DOUBLE_EQ(budget.left(), -300);
  budget.refill(Time{milliseconds(500)});
  EXPECT_DOUBLE_EQ(budget.left(), 200);
}

TEST(ByteBudget, InALongTimeNoMoreIsSpentThanTheRateAndOneSecond) {
  ByteBudget budget(1000);
  double spent = 0;
  for (int i = 0; i <= 600; ++i) {
    budget.refill(Time{milliseconds(100 * i)});
    for (; budget.left() >= 70; spent += 70) budget.spend(70);
  }
  EXPECT_LE(spent, 61 * 1000);
  EXPECT_GE(spent, 59 * 1000);
}

}  // namespace
}  // namespace cairn::peers
