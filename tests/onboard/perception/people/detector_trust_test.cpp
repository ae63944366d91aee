// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/detector_trust.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::people {
namespace {

TEST(DetectorTrust, AUsualBoxSaysWhatWaldSays) {
  const DetectorTrust trust{.recall = 0.8, .false_share = 0.1, .usual_score = 0.7};
  EXPECT_NEAR(trust.of_box(0.7), std::log(8), 1e-12);
  EXPECT_NEAR(trust.of_silence(0), std::log(0.2 / 0.9), 1e-12);
}

TEST(DetectorTrust, SilenceSaysLessOfWhoIsFar) {
  const DetectorTrust trust{.farthest_m = 10};
  for (double distance = 0; distance < 12; distance += 0.5) {
    EXPECT_LE(trust.of_silence(distance), trust.of_silence(distance + 0.5)) << distance;
  }
  EXPECT_LT(trust.of_silence(3), 0.7 * trust.of_silence(0));
  EXPECT_EQ(trust.of_silence(10), 0);
  EXPECT_EQ(trust.of_silence(30), 0);
}

TEST(DetectorTrust, ASurerBoxSaysMoreAndAWeakOneNothing) {
  const DetectorTrust trust{.recall = 0.8, .false_share = 0.1, .usual_score = 0.7, .score_slope = 10};
  EXPECT_NEAR(trust.of_box(0.8) - trust.of_box(0.7), 1, 1e-12);
  EXPECT_EQ(trust.of_box(0.1), 0);
  EXPECT_EQ(trust.of_box(5), DetectorTrust::kMostOfABox);
}

TEST(DetectorTrust, WithoutASlopeAllBoxesCountAlike) {
  const DetectorTrust trust{.score_slope = 0};
  EXPECT_EQ(trust.of_box(0.1), trust.of_box(0.9));
}

}  // namespace
}  // namespace cairn::people
