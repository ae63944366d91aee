// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/fold.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace cairn::merging {
namespace {

float fold_of_two(Policy policy, double p, double q) {
  const std::vector<float> opinions{log_odds(p), log_odds(q)};
  return fold(policy, opinions, {});
}
double fused_probability(Policy policy, double p, double q) { return probability(fold_of_two(policy, p, q)); }

TEST(RelativeEntropy, IsTheBooksFormula) {
  EXPECT_NEAR(relative_entropy(0.7, 0.7), 0, 1e-15);
  EXPECT_NEAR(relative_entropy(0.9, 0.6), 0.9 * std::log(1.5) + 0.1 * std::log(0.25), 1e-12);
  EXPECT_TRUE(std::isinf(relative_entropy(0.5, 1)));
  EXPECT_NEAR(relative_entropy(1, 0.5), std::log(2), 1e-12);
}

TEST(Fold, RelativeEntropyAveragesWhatAgreesAndKeepsTheSurerOtherwise) {
  EXPECT_NEAR(fused_probability(Policy::kRelativeEntropy, 0.8, 0.7), 0.75, 1e-6);  // 0.026 nats
  EXPECT_NEAR(fused_probability(Policy::kRelativeEntropyWeighted, 0.8, 0.7), (0.64 + 0.49) / 1.5, 1e-6);
  EXPECT_NEAR(fused_probability(Policy::kRelativeEntropy, 0.95, 0.6), 0.95,
              1e-6);  // 0.33 nats: the larger p, as in the book
  EXPECT_NEAR(fused_probability(Policy::kRelativeEntropy, 0.6, 0.95), 0.95, 1e-6);
  EXPECT_NEAR(fused_probability(Policy::kRelativeEntropy, 0.6, 0.12), 0.12,
              1e-6);  // a sure free observation clears a ghost
  EXPECT_NEAR(fused_probability(Policy::kRelativeEntropy, 0.9, 0.1), 0.9, 1e-6);  // equally sure: occupied
}

TEST(Fold, BayesAddsLogOddsWithinTheLimits) {
  EXPECT_NEAR(fold_of_two(Policy::kBayes, 0.7, 0.6), std::log(7.0 / 3) + std::log(1.5), 1e-6);
  EXPECT_EQ(fold_of_two(Policy::kBayes, 0.97, 0.97), Limits{}.max);
  EXPECT_EQ(fold_of_two(Policy::kBayes, 0.12, 0.12), Limits{}.min);
  EXPECT_NEAR(fold_of_two(Policy::kBayes, 0.7, 0.3), 0, 1e-6);
}

TEST(Fold, AverageAndStitch) {
  EXPECT_NEAR(fused_probability(Policy::kAverage, 0.9, 0.2), 0.55, 1e-6);
  EXPECT_NEAR(fused_probability(Policy::kStitch, 0.6, 0.9), 0.6, 1e-6);
}

TEST(Fold, EqualOpinionsStayToTheBit) {
  for (const Policy policy :
       {Policy::kRelativeEntropy, Policy::kRelativeEntropyWeighted, Policy::kAverage, Policy::kStitch})
    for (const float v : {-2.0F, -0.405F, 0.0F, 0.8473F, 3.5F})
      EXPECT_EQ(fold(policy, std::vector<float>(5, v), {}), v);
  for (const auto name : policy_names()) EXPECT_EQ(fold(*policy_from(name), std::vector<float>{0.123F}, {}), 0.123F);
}

TEST(Fold, SumsDoNotDependOnTheOrder) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> at(-0.5F, 0.6F);
  for (int i = 0; i < 200; ++i) {
    std::vector<float> opinions(6);
    for (float& v : opinions) v = at(random);
    for (const Policy policy : {Policy::kBayes, Policy::kAverage}) {
      const float before = fold(policy, opinions, {});
      std::shuffle(opinions.begin(), opinions.end(), random);
      EXPECT_EQ(fold(policy, opinions, {}), before);
    }
  }
}

TEST(Fold, RelativeEntropyNeverLeavesTheRangeOfTheOpinions) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> at(-2, 3.5F);
  for (int i = 0; i < 500; ++i) {
    std::vector<float> opinions(2 + random() % 4);
    for (float& v : opinions) v = at(random);
    const auto [low, high] = std::minmax_element(opinions.begin(), opinions.end());
    for (const Policy policy : {Policy::kRelativeEntropy, Policy::kRelativeEntropyWeighted, Policy::kAverage}) {
      EXPECT_GE(fold(policy, opinions, {}), *low - 1e-5F);
      EXPECT_LE(fold(policy, opinions, {}), *high + 1e-5F);
    }
  }
}

TEST(Policy, NamesAreThoseOfTheCommandLine) {
  for (const auto name : policy_names()) EXPECT_TRUE(policy_from(name));
  for (const auto* name : {"relative_entropy", "bayes", "average", "stitch"}) EXPECT_TRUE(policy_from(name)) << name;
  EXPECT_FALSE(policy_from("sum"));
}

}  // namespace
}  // namespace cairn::merging
