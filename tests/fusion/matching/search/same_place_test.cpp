// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/same_place.hpp"

#include <gtest/gtest.h>

#include "tests/fusion/matching/planar_pose.hpp"

namespace cairn::matching {
namespace {

TEST(SamePlace, IsNearInPlaceAndInTurn) {
  const SE3 T = planar_pose(3, -2, 1);
  EXPECT_TRUE(same_place(T, T));
  EXPECT_TRUE(same_place(T, T * planar_pose(0.5, 0.6, 0.06)));
  EXPECT_FALSE(same_place(T, T * planar_pose(0.6, 0.6, 0)));
  EXPECT_FALSE(same_place(T, T * planar_pose(0, 0, 0.08)));
  EXPECT_FALSE(same_place(T, T * SE3(Eigen::Quaterniond::Identity(), {0, 0, 0.9})));
}

TEST(SamePlace, OfTwoPosesIsTheRuleForTheirDistances) {
  const SE3 T = planar_pose(3, -2, 1);
  for (const double metres : {0.1, 0.79, 0.81})
    for (const double turn : {-0.071, -0.069, 0.0, 0.069, 0.071})
      EXPECT_EQ(same_place(T, T * planar_pose(metres, 0, turn)), same_place(metres, std::abs(turn)))
          << metres << " " << turn;
}

}  // namespace
}  // namespace cairn::matching
