// SPDX-License-Identifier: Apache-2.0
#include "hal/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace cairn {
namespace {

TEST(Histogram, PercentilesAreWithinOnePercentOfTheSortedTruth) {
  std::mt19937_64 random(3);
  std::lognormal_distribution<double> duration(13.0, 2.0);
  Histogram histogram;
  std::vector<std::int64_t> truth;
  for (int i = 0; i < 20000; ++i) {
    truth.push_back(static_cast<std::int64_t>(duration(random)));
    histogram.record(Duration{truth.back()});
  }
  std::sort(truth.begin(), truth.end());
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(truth.size()))) - 1;
    const auto exact = static_cast<double>(truth[rank]);
    EXPECT_NEAR(static_cast<double>(histogram.percentile(share).count()), exact, 0.01 * exact + 1) << share;
  }
  EXPECT_EQ(histogram.max().count(), truth.back());
  EXPECT_EQ(histogram.count(), truth.size());
}

TEST(Histogram, BucketsTileTheWholeRangeWithoutGaps) {
  Histogram h;
  for (std::size_t i = 0; i + 1 < Histogram::kBuckets; ++i) {
    EXPECT_LT(h.bucket(i).lower, h.bucket(i).upper);
    ASSERT_EQ(h.bucket(i).upper, h.bucket(i + 1).lower);
  }
}

TEST(Histogram, EveryValueFallsIntoTheBucketThatContainsIt) {
  for (std::int64_t ns :
       {0L, 1L, 255L, 256L, 257L, 511L, 512L, 1000L, 1L << 20, (1L << 20) + 12345, 3'600'000'000'000L}) {
    Histogram h;
    h.record(Duration{ns});
    for (std::size_t i = 0; i < Histogram::kBuckets; ++i)
      if (h.bucket(i).count != 0 && i + 1 < Histogram::kBuckets) {
        EXPECT_LE(h.bucket(i).lower.count(), ns);
        EXPECT_GT(h.bucket(i).upper.count(), ns);
      }
  }
}

TEST(Histogram, EmptyAndNegativeAreHarmless) {
  Histogram h;
  EXPECT_EQ(h.percentile(0.5).count(), 0);
  EXPECT_EQ(h.mean().count(), 0);
  h.record(Duration{-5});
  EXPECT_EQ(h.percentile(1.0).count(), 0);
  EXPECT_EQ(h.count(), 1U);
}

}  // namespace
}  // namespace cairn
