// SPDX-License-Identifier: Apache-2.0
#include "hal/workers.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace cairn {
namespace {

TEST(Workers, EveryChunkRunsExactlyOnceForAnyNumberOfThreads) {
  for (const unsigned threads : {1U, 2U, 5U}) {
    Workers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    for (const std::size_t chunks : {0U, 1U, 2U, 1000U}) {
      std::vector<int> ran(chunks, 0);
      for (int repeat = 0; repeat < 50; ++repeat) workers.for_each(chunks, [&](std::size_t i) { ++ran[i]; });
      for (const int n : ran) EXPECT_EQ(n, 50);
    }
  }
}

TEST(Workers, AnOrderedReductionIsTheSameForAnyNumberOfThreads) {
  const auto sum = [](unsigned threads) {
    Workers workers(threads);
    std::vector<double> parts(64);
    workers.for_each(parts.size(), [&](std::size_t i) {
      for (std::size_t k = 1; k < 100; ++k) parts[i] += 1.0 / static_cast<double>(k + i);
    });
    double total = 0;
    for (const double p : parts) total += p;
    return total;
  };
  EXPECT_EQ(sum(1), sum(2));
  EXPECT_EQ(sum(1), sum(4));
}

}  // namespace
}  // namespace cairn
