// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/disparity_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace cairn::stereo {
namespace {

constexpr int kColumns = 40, kRows = 30, kLeast = 12;
constexpr double kGate = 0.5;

/// Samples of a function of column and row.
DisparityField field(const std::function<double(int, int)>& disparity) {
  DisparityField field;
  field.reset(kColumns, kRows);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) field.set(column, row, disparity(column, row));
  return field;
}

double leaning(int column, int row) { return 12 + 0.11 * column - 0.07 * row; }

TEST(DisparityField, AnExactPlaneStaysAsItIsUpToTheEdge) {
  const DisparityField plane = field(leaning);
  for (const auto& [column, row] : {std::pair(0, 0), std::pair(20, 15), std::pair(kColumns - 1, kRows - 1)})
    EXPECT_NEAR(plane.on_plane(column, row, kGate, kLeast).value_or(0), leaning(column, row), 1e-3);
}

TEST(DisparityField, NoiseIsAThirdOfWhatItWas) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.2);
  const DisparityField noisy = field([&](int column, int row) { return leaning(column, row) + noise(random); });
  double before = 0, after = 0;
  int found = 0;
  random.seed(1);
  noise.reset();
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      before += std::pow(noise(random), 2);
      const auto d = noisy.on_plane(column, row, kGate, kLeast);
      if (!d) continue;
      ++found;
      after += std::pow(*d - leaning(column, row), 2);
    }
  EXPECT_GT(found, kColumns * kRows * 95 / 100);
  EXPECT_LT(after, before / 9);
}

TEST(DisparityField, AnEdgeBetweenNearAndFarStaysSharp) {
  const DisparityField step = field([](int column, int) { return column < 20 ? 8.0 : 14.0; });
  EXPECT_NEAR(step.on_plane(19, 15, kGate, kLeast).value_or(0), 8, 1e-3);
  EXPECT_NEAR(step.on_plane(20, 15, kGate, kLeast).value_or(0), 14, 1e-3);
}

TEST(DisparityField, ASampleAloneIsAWrongMatch) {
  DisparityField plane = field(leaning);
  plane.set(20, 15, leaning(20, 15) + 3);
  EXPECT_FALSE(plane.on_plane(20, 15, kGate, kLeast));
  EXPECT_NEAR(plane.on_plane(21, 15, kGate, kLeast).value_or(0), leaning(21, 15), 1e-3);  // and spoils no other
}

TEST(DisparityField, WhereNothingWasMeasuredThereIsNothing) {
  DisparityField empty;
  empty.reset(kColumns, kRows);
  empty.set(3, 4, 9);
  EXPECT_FALSE(empty.on_plane(4, 4, kGate, 1));
  EXPECT_NEAR(empty.on_plane(3, 4, kGate, 1).value_or(0), 9, 1e-6);  // one sample has no slope
  EXPECT_FALSE(empty.on_plane(3, 4, kGate, 2));
  empty.reset(kColumns, kRows);
  EXPECT_FALSE(empty.on_plane(3, 4, kGate, 1));
}

TEST(DisparityField, ARowOfSamplesHasNoSlopeAcross) {
  DisparityField row;
  row.reset(kColumns, kRows);
  for (int column = 0; column < kColumns; ++column) row.set(column, 7, leaning(column, 7));
  EXPECT_NEAR(row.on_plane(20, 7, kGate, 3).value_or(0), leaning(20, 7), 1e-2);
}

}  // namespace
}  // namespace cairn::stereo
