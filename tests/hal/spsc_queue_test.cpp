// SPDX-License-Identifier: Apache-2.0
#include "hal/spsc_queue.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "hal/workers.hpp"

namespace cairn {
namespace {

TEST(SpscQueue, GivesBackInOrderAndRefusesWhenFull) {
  SpscQueue<int> queue(3);
  EXPECT_EQ(queue.front(), nullptr);
  for (int i = 0; i < 3; ++i) {
    *queue.back() = i;
    queue.push();
  }
  EXPECT_EQ(queue.back(), nullptr);
  EXPECT_EQ(queue.size(), 3U);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(*queue.front(), i);
    queue.pop();
    *queue.back() = i + 3;
    queue.push();
  }
  EXPECT_EQ(queue.size(), queue.capacity());
}

TEST(SpscQueue, KeepsTheMemoryOfItsElements) {
  SpscQueue<std::vector<int>> queue(1);
  std::size_t grown = 0;
  for (int round = 0; round < 6; ++round) {
    queue.back()->assign(1000, round);
    queue.push();
    if (round >= 2) grown += queue.front()->capacity() >= 1000 ? 0U : 1U;
    queue.front()->clear();
    queue.pop();
  }
  EXPECT_EQ(grown, 0U);
}

TEST(SpscQueue, TwoThreadsSeeEveryElementOnceAndWhole) {
  struct Pair {
    std::uint64_t a = 0, b = 0;
  };
  constexpr std::uint64_t kCount = 100'000;
  SpscQueue<Pair> queue(7);
  std::uint64_t wrong = 0;
  Workers workers(2);
  workers.for_each(2, [&](std::size_t side) {
    for (std::uint64_t i = 0; i < kCount;) {
      if (side == 0) {
        if (Pair* p = queue.back()) {
          *p = {i, ~i};
          queue.push();
          ++i;
        }
      } else if (const Pair* p = queue.front()) {
        wrong += p->a == i && p->b == ~i ? 0U : 1U;
        queue.pop();
        ++i;
      }
    }
  });
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace cairn
