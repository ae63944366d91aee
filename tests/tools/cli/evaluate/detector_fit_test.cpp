// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/detector_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace cairn::cli {
namespace {

/// Boxes of people have the mean score 0.7, those of others 0.5; both vary by 0.1. So the log odds change by
/// (0.7 − 0.5) / 0.1² = 20 for each 1 of the score.
std::vector<LookedAt> two_bells(int people, int others, double recall, double false_share) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> bell(0, 0.1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<LookedAt> bodies;
  for (int i = 0; i < people + others; ++i) {
    const bool person = i < people, boxed = uniform(random) < (person ? recall : false_share);
    bodies.push_back({person, boxed, boxed ? (person ? 0.7 : 0.5) + bell(random) : 0});
  }
  return bodies;
}

TEST(DetectorFit, FindsWhatTheBodiesWereDrawnFrom) {
  const auto fit = fit_detector(two_bells(8000, 8000, 0.6, 0.1));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->recall, 0.6, 0.02);
  EXPECT_NEAR(fit->false_share, 0.1, 0.01);
  EXPECT_NEAR(fit->score_slope, 20, 4 * fit->slope_sigma);
  EXPECT_LT(fit->slope_sigma, 1.5);
  // At 0.6 both bells are as high, so there a box says ln(recall / false_share).
  EXPECT_NEAR(fit->usual_score, 0.6, 0.01);
}

TEST(DetectorFit, DoesNotDependOnHowManyOthersThereAre) {
  const auto few = fit_detector(two_bells(8000, 2000, 0.6, 0.1)), many = fit_detector(two_bells(4000, 20000, 0.6, 0.1));
  ASSERT_TRUE(few && many);
  EXPECT_NEAR(few->usual_score, many->usual_score, 0.02);
  EXPECT_NEAR(few->score_slope, many->score_slope, 4 * (few->slope_sigma + many->slope_sigma));
}

TEST(DetectorFit, ScoresThatPartBothKindsGiveAFiniteSlope) {
  std::vector<LookedAt> bodies;
  for (int i = 0; i < 50; ++i) {
    bodies.push_back({true, true, 0.8 + 0.001 * i});
    bodies.push_back({false, i < 10, i < 10 ? 0.4 : 0});
  }
  const auto fit = fit_detector(bodies);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(std::isfinite(fit->score_slope));
  EXPECT_GT(fit->score_slope, 5);
  EXPECT_LT(fit->score_slope, 100);
}

TEST(DetectorFit, FewBoxesGiveNoSlopeAndFewBodiesNothing) {
  std::vector<LookedAt> bodies;
  for (int i = 0; i < 30; ++i) bodies.insert(bodies.end(), {{true, true, 0.7}, {false, false, 0}});
  const auto fit = fit_detector(bodies);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->score_slope, 0);
  EXPECT_NEAR(fit->usual_score, 0.7, 1e-9);
  EXPECT_NEAR(fit->false_share, 1.0 / 32, 1e-9) << "none of 30 is not never";
  EXPECT_EQ(fit->boxes[7].people, 30U);
  bodies.resize(20);
  EXPECT_FALSE(fit_detector(bodies));
  EXPECT_FALSE(fit_detector({}));
}

}  // namespace
}  // namespace cairn::cli
