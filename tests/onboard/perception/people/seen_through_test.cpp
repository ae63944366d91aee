// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/seen_through.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people {
namespace {

using test::scan_of;

TEST(SeenThrough, AnEmptyPlaceBeforeAWallIs) { EXPECT_TRUE(seen_through({6, 0}, 0, scan_of({}), test::sensor())); }

TEST(SeenThrough, WhereSomebodyStandsIsNot) {
  EXPECT_FALSE(seen_through({6, 0}, 0, scan_of({{{6, 0}}}), test::sensor()));
}

TEST(SeenThrough, WhatSomethingHidesIsNot) {
  EXPECT_FALSE(seen_through({6, 0}, 0, scan_of({{{3, 0}, 0.5, 2.0}}), test::sensor()));
}

TEST(SeenThrough, WithoutAnythingBehindNobodyCanTell) {
  std::vector<Eigen::Vector3f> nothing;
  EXPECT_FALSE(seen_through({6, 0}, 0, nothing, test::sensor()));
  EXPECT_FALSE(seen_through({0, 0}, 0, scan_of({}), test::sensor())) << "at the sensor itself";
}

}  // namespace
}  // namespace cairn::people
