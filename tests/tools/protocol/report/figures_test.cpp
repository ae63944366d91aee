// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/report/figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace cairn::protocol {
namespace {

Attempt attempt(int start, double m, double deg, bool accepted = false) {
  return {start, {}, {m, deg}, 0.5, 10, accepted, {}};
}

TEST(Figures, MeansAreOverAllStartsAndOverSuccesses) {
  std::vector<Attempt> attempts{attempt(0, 0.1, 1, true), attempt(1, 0.3, 3), attempt(2, 2.0, 2, true),
                                attempt(3, 0.2, 10)};
  attempts[0].rms_m = 0.2;
  attempts[2].rms_m = 0.4;
  attempts[3].seconds = 2.5;
  const Figures f = figures_of(attempts);
  EXPECT_EQ(f.starts, 4);
  EXPECT_DOUBLE_EQ(f.success, 0.5);
  EXPECT_DOUBLE_EQ(f.mean_error_m, 0.65);
  EXPECT_DOUBLE_EQ(f.mean_error_deg, 4);
  EXPECT_DOUBLE_EQ(f.median_error_m, 0.25);
  EXPECT_DOUBLE_EQ(f.success_error_m, 0.2);
  EXPECT_DOUBLE_EQ(f.success_error_deg, 2);
  EXPECT_DOUBLE_EQ(f.seconds, 1);
  EXPECT_DOUBLE_EQ(f.slowest_s, 2.5);
  EXPECT_DOUBLE_EQ(f.accepted, 0.5);
  EXPECT_DOUBLE_EQ(f.wrongly_accepted, 0.25);
  EXPECT_DOUBLE_EQ(f.rms_m, 0.3);
  EXPECT_EQ(figures_of({}).starts, 0);
}

TEST(Figures, ABoxHoldsTheMiddleHalf) {
  std::mt19937 random(1);
  std::vector<double> values(400);
  for (double& v : values) v = static_cast<double>(random()) / 4294967296.0;
  values.push_back(9);
  const Box box = box_of(values);
  const auto within = [&](double low, double high) {
    return std::count_if(values.begin(), values.end(), [&](double v) { return v >= low && v <= high; });
  };
  EXPECT_NEAR(static_cast<double>(within(box.lower, box.upper)), 200.5, 1.5);
  EXPECT_NEAR(static_cast<double>(within(0, box.median)), 201, 1);
  EXPECT_THAT(box.outliers, testing::ElementsAre(9));
  EXPECT_LE(box.high, 1);
  EXPECT_EQ(within(box.low, box.high), 400);
  EXPECT_NEAR(box.mean, std::accumulate(values.begin(), values.end(), 0.0) / 401, 1e-12);
}

TEST(Figures, ABoxOfOneValueIsThatValue) {
  const Box box = box_of({0.7});
  for (const double v : {box.low, box.lower, box.median, box.upper, box.high, box.mean}) EXPECT_DOUBLE_EQ(v, 0.7);
}

TEST(Figures, SuccessIsCountedByDistance) {
  std::vector<Attempt> attempts;
  for (int i = 0; i < 125; ++i)
    attempts.push_back(attempt(i, starts()[static_cast<std::size_t>(i)].distance_m() < 1.2 ? 0.1 : 3, 0));
  const auto shares = success_by_distance(attempts);
  ASSERT_EQ(shares.size(), 6U);  // 0, 1, √2, 2, √5, √8
  for (const SuccessAt& s : shares) EXPECT_DOUBLE_EQ(s.success, s.distance_m < 1.2 ? 1 : 0);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end(),
                             [](const auto& a, const auto& b) { return a.distance_m < b.distance_m; }));
}

}  // namespace
}  // namespace cairn::protocol
