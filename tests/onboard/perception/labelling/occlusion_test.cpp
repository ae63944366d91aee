// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/occlusion.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/labelling/scene.hpp"

namespace cairn::labelling {
namespace {

Projected seen(float u, float v, float depth) { return {.u = u, .v = v, .depth = depth, .range = depth}; }

class Occluding : public ::testing::Test {
 protected:
  bool hidden(const std::vector<Projected>& nearer, std::uint8_t class_id = kNoClass) {
    const Projected behind = seen(100, 100, 10);
    for (const Projected& p : nearer) occlusion_.add(p, class_id);
    occlusion_.add(behind, class_id);
    const bool found = occlusion_.hidden(behind, class_id);
    occlusion_.clear(nearer);
    occlusion_.clear(std::vector{behind});
    return found;
  }
  Occlusion occlusion_{test::small_camera(), {}};
};

TEST_F(Occluding, WhatIsFarNearerInTheWindowHides) {
  EXPECT_FALSE(hidden({}));
  EXPECT_TRUE(hidden({seen(102, 98, 5)}));
  EXPECT_FALSE(hidden({seen(103, 100, 5)})) << "beside the window";
  EXPECT_FALSE(hidden({seen(100, 100, 9.2F)})) << "hardly nearer";
  EXPECT_FALSE(hidden({})) << "what was noted is forgotten";
}

TEST_F(Occluding, BetweenTwoLasersItTakesOneAboveAndOneBelow) {
  EXPECT_TRUE(hidden({seen(100, 94, 5), seen(100, 106, 5)}));
  EXPECT_FALSE(hidden({seen(100, 106, 5)})) << "as the ground is nearer below";
  EXPECT_FALSE(hidden({seen(100, 90, 5), seen(100, 110, 5)})) << "farther than 2.2 degrees";
}

TEST_F(Occluding, OfWhatStandsUprightOneOfTheSameClassIsEnough) {
  EXPECT_TRUE(hidden({seen(100, 106, 5)}, test::kCar));
  EXPECT_FALSE(hidden({seen(100, 106, 5)}, test::kRoad));
}

}  // namespace
}  // namespace cairn::labelling
