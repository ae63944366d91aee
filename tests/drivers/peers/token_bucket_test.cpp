// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/token_bucket.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace cairn::peer_link {
namespace {

using std::chrono::milliseconds;

/// Whatever is offered when, no second lets more through; and a steady sender gets what it may have.
TEST(TokenBucket, NoSecondIsAboveTheCap) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    TokenBucket bucket(8000);
    std::deque<std::pair<Time, std::size_t>> sent;
    std::size_t in_window = 0;
    Time now{};
    for (int i = 0; i < 5000; ++i) {
      now += milliseconds(random() % 50 == 0 ? 3000 : random() % 20);
      const std::size_t bytes = 40 + random() % 1200;
      if (!bucket.take(bytes, now, random() % 4 == 0)) continue;
      sent.emplace_back(now, bytes);
      in_window += bytes;
      while (sent.front().first + std::chrono::seconds(1) <= now) {
        in_window -= sent.front().second;
        sent.pop_front();
      }
      ASSERT_LE(in_window, 8000U);
    }
  }
}

TEST(TokenBucket, ASteadySenderGetsMostOfTheCap) {
  TokenBucket bucket(8000);
  std::size_t through = 0;
  for (int ms = 0; ms < 60'000; ms += 5)
    if (bucket.take(300, Time{milliseconds(ms)})) through += 300;
  EXPECT_GE(through, 60U * 5000);
}

TEST(TokenBucket, WhatIsUrgentGetsThroughAFloodOfTheRest) {
  TokenBucket bucket(8000);
  int refused = 0;
  for (int ms = 0; ms < 10'000; ++ms) {
    (void)bucket.take(1200, Time{milliseconds(ms)});
    if (ms % 500 == 0 && !bucket.take(700, Time{milliseconds(ms)}, true)) ++refused;
  }
  EXPECT_EQ(refused, 0);
}

}  // namespace
}  // namespace cairn::peer_link
