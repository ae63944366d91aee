// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace cairn::merging {
namespace {

constexpr std::size_t kRoad = 0, kCar = 13;  // trainIds

/// `p` for one class, the rest shared evenly.
ClassProbabilities mostly(std::size_t label, double p) {
  ClassProbabilities all;
  all.fill((1 - p) / (kClasses - 1));
  all[label] = p;
  return all;
}
std::size_t label_of(const ClassProbabilities& p) {
  return static_cast<std::size_t>(std::max_element(p.begin(), p.end()) - p.begin());
}

TEST(FuseLabels, TheSurerLabelWinsAsInTable73) {
  for (const auto& [road, car] : {std::pair{0.638, 0.973}, {0.711, 0.985}, {0.834, 0.992}})
    EXPECT_EQ(label_of(fuse_labels(std::vector<ClassProbabilities>{mostly(kRoad, road), mostly(kCar, car)})), kCar);
}

TEST(FuseLabels, AgreeingLabelsGrowAsInTable74) {
  const auto fused = fuse_labels(std::vector<ClassProbabilities>{mostly(kCar, 0.7), mostly(kCar, 0.6)});
  EXPECT_EQ(label_of(fused), kCar);
  EXPECT_GT(fused[kCar], 0.7);
  EXPECT_LT(label_entropy(fused), label_entropy(mostly(kCar, 0.7)));
}

TEST(FuseLabels, AnOpinionAtThePriorChangesNothing) {
  const auto alone = fuse_labels(std::vector<ClassProbabilities>{mostly(kCar, 0.7)});
  const auto with = fuse_labels(std::vector<ClassProbabilities>{mostly(kCar, 0.7), mostly(0, 1.0 / kClasses)});
  for (std::size_t k = 0; k < kClasses; ++k) EXPECT_NEAR(with[k], alone[k], 1e-9);
}

TEST(FuseLabels, IsNormalisedAndDoesNotDependOnTheOrder) {
  const auto ab = fuse_labels(std::vector<ClassProbabilities>{mostly(1, 0.8), mostly(2, 0.9), mostly(3, 1.0)});
  const auto ba = fuse_labels(std::vector<ClassProbabilities>{mostly(3, 1.0), mostly(1, 0.8), mostly(2, 0.9)});
  EXPECT_EQ(ab, ba);
  EXPECT_NEAR(std::accumulate(ab.begin(), ab.end(), 0.0), 1, 1e-12);
}

TEST(LabelEntropy, IsZeroForCertaintyAndOneForNone) {
  EXPECT_NEAR(label_entropy(mostly(4, 1.0)), 0, 1e-12);
  EXPECT_NEAR(label_entropy(mostly(4, 1.0 / kClasses)), 1, 1e-12);
}

}  // namespace
}  // namespace cairn::merging
