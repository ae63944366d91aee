// SPDX-License-Identifier: Apache-2.0
#include "hal/latest_value.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "hal/workers.hpp"

namespace cairn {
namespace {

TEST(LatestValue, TheReaderSeesTheNewestAndKeepsIt) {
  LatestValue<int> value;
  EXPECT_FALSE(value.refresh());
  EXPECT_EQ(value.value(), 0);
  value.publish(1);
  value.publish(2);
  EXPECT_EQ(value.value(), 0) << "until it asks";
  EXPECT_TRUE(value.refresh());
  EXPECT_EQ(value.value(), 2);
  EXPECT_FALSE(value.refresh());
  EXPECT_EQ(value.value(), 2);
}

TEST(LatestValue, TwoThreadsNeverSeeHalfAValueNorAnOlderOne) {
  struct Value {
    std::uint64_t a = 0, b = ~std::uint64_t{0};
  };
  constexpr std::uint64_t kCount = 100'000;
  LatestValue<Value> value;
  std::uint64_t wrong = 0, last = 0;
  Workers workers(2);
  workers.for_each(2, [&](std::size_t side) {
    if (side == 0) {
      for (std::uint64_t i = 1; i <= kCount; ++i) value.publish({i, ~i});
    } else {
      while (last < kCount) {
        if (!value.refresh()) continue;
        const Value& v = value.value();
        wrong += v.b == ~v.a && v.a > last ? 0U : 1U;
        last = v.a;
      }
    }
  });
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace cairn
