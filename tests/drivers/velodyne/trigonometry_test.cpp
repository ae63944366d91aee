// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/trigonometry.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::velodyne {
namespace {

TEST(Trigonometry, AgreesWithTheLibrary) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-1000, 1000);
  for (int i = 0; i < 100'000; ++i) {
    const double degrees = any(random);
    // The library gets an argument below one turn, where the conversion to radians does not yet lose digits.
    const double radians = std::remainder(degrees, 360.0) * (std::numbers::pi / 180.0);
    const SinCos got = sin_cos_deg(degrees);
    ASSERT_NEAR(got.sin, std::sin(radians), 1e-15) << degrees;
    ASSERT_NEAR(got.cos, std::cos(radians), 1e-15) << degrees;
  }
}

TEST(Trigonometry, IsExactAtQuarterTurns) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const SinCos got = sin_cos_deg(90.0 * quarter);
    const int q = ((quarter % 4) + 4) % 4;
    EXPECT_EQ(got.sin, q == 1 ? 1 : q == 3 ? -1 : 0) << quarter;
    EXPECT_EQ(got.cos, q == 0 ? 1 : q == 2 ? -1 : 0) << quarter;
  }
}

TEST(Trigonometry, SmallAngles) {
  for (double radians = -0.02; radians <= 0.02; radians += 1e-5) {
    EXPECT_NEAR(sin_cos_small(radians).sin, std::sin(radians), 1e-12);
    EXPECT_NEAR(sin_cos_small(radians).cos, std::cos(radians), 1e-12);
  }
}

TEST(Trigonometry, WrapStaysBelowAFullTurn) {
  EXPECT_EQ(wrap_360(0), 0);
  EXPECT_EQ(wrap_360(360), 0);
  EXPECT_EQ(wrap_360(-1e-20), 0);
  EXPECT_DOUBLE_EQ(wrap_360(359.99), 359.99);
  EXPECT_DOUBLE_EQ(wrap_360(360.02), 360.02 - 360);
  EXPECT_DOUBLE_EQ(wrap_360(-90), 270);
}

}  // namespace
}  // namespace cairn::velodyne
