// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/starts.hpp"

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

TEST(Starts, AnyStrideTakesTheExactOne) {
  for (const int stride : {1, 2, 5, 7, 124}) {
    const auto chosen = chosen_starts(stride);
    int exact = 0;
    for (const int i : chosen) exact += starts().at(static_cast<std::size_t>(i)).distance_m() == 0 && i == kExactStart;
    EXPECT_EQ(exact, 1) << stride;
  }
  EXPECT_EQ(chosen_starts(1).size(), 125U);
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
