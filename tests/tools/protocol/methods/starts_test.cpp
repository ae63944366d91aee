// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/methods/starts.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <tuple>

namespace cairn::protocol {
namespace {

const SE3 kTruth = SE3::from_xyz_rpy((Vector6() << 8, -3, 0.5, 0.01, -0.02, 2.5).finished());

TEST(Starts, AreTheBooks125) {
  std::set<std::tuple<double, double, double>> different;
  for (const Start& s : starts()) {
    EXPECT_LE(std::abs(s.x_m), 2);
    EXPECT_LE(std::abs(s.y_m), 2);
    EXPECT_LE(std::abs(s.yaw_deg), 15);
    different.emplace(s.x_m, s.y_m, s.yaw_deg);
  }
  EXPECT_EQ(starts().size(), 125U);
  EXPECT_EQ(different.size(), 125U);
}

TEST(Starts, EachIsOffByWhatItSays) {
  for (const Start& s : starts()) {
    const PoseError error = error_of(start_pose(kTruth, s), kTruth);
    EXPECT_NEAR(error.m, s.distance_m(), 1e-9);
    EXPECT_NEAR(error.deg, std::abs(s.yaw_deg), 1e-6);
  }
}

TEST(Starts, AFewAreSpreadOverAll) {
  const auto few = chosen_starts(25);
  std::set<std::pair<double, double>> x_y, x_yaw, y_yaw;
  std::set<double> x, y, yaw;
  for (std::size_t n = 0; n < few.size(); ++n) {
    const Start& s = starts().at(static_cast<std::size_t>(few[n]));
    x_y.emplace(s.x_m, s.y_m);
    x_yaw.emplace(s.x_m, s.yaw_deg);
    y_yaw.emplace(s.y_m, s.yaw_deg);
    if (n >= 5) continue;
    x.insert(s.x_m);
    y.insert(s.y_m);
    yaw.insert(s.yaw_deg);
  }
  for (const auto& pairs : {x_y, x_yaw, y_yaw}) EXPECT_EQ(pairs.size(), 25U);
  for (const auto& values : {x, y, yaw}) EXPECT_EQ(values.size(), 5U);
}

TEST(Starts, AnyNumberOfThemBeginsWithTheExactOneAndTakesNoneTwice) {
  for (const int count : {1, 2, 5, 7, 25, 124, 125, 1000}) {
    const auto chosen = chosen_starts(count);
    EXPECT_EQ(chosen.front(), kExactStart);
    EXPECT_EQ(std::set<int>(chosen.begin(), chosen.end()).size(), static_cast<std::size_t>(std::min(count, kStarts)));
  }
  EXPECT_EQ(error_of(start_pose(kTruth, starts()[kExactStart]), kTruth).m, 0);
}

TEST(PoseError, DoesNotDependOnWhereTheOriginIs) {
  const SE3 moved = SE3::from_xyz_rpy((Vector6() << 100, 50, 0, 0, 0, 1).finished());
  const SE3 estimate = start_pose(kTruth, {0.3, -0.4, 5});
  const PoseError here = error_of(estimate, kTruth), there = error_of(moved * estimate, moved * kTruth);
  EXPECT_NEAR(here.m, 0.5, 1e-9);
  EXPECT_NEAR(there.m, here.m, 1e-9);
  EXPECT_NEAR(there.deg, here.deg, 1e-6);
}

TEST(PoseError, SuccessIsTheBooksCriterion) {
  EXPECT_TRUE((PoseError{0.6, 6}.success()));
  EXPECT_FALSE((PoseError{0.61, 0}.success()));
  EXPECT_FALSE((PoseError{0, 6.1}.success()));
}

}  // namespace
}  // namespace cairn::protocol
