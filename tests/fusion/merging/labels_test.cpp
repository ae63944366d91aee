// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
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

std::vector<mapping::VoxelLabel> random_labels(std::mt19937& random, unsigned classes) {
  std::vector<mapping::VoxelLabel> labels;
  for (auto count = 1 + random() % 5; count > 0; --count) {
    const unsigned class_id = static_cast<unsigned>(random() % classes);
    labels.push_back(mapping::VoxelLabel::of(class_id, static_cast<unsigned>(random() % mapping::VoxelLabel::kGrades)));
  }
  return labels;
}

TEST(FuseCoarseLabels, OneOpinionStaysWhatItIs) {
  for (unsigned code = 1; code <= mapping::VoxelLabel::kCodes; ++code) {
    const std::array only{mapping::VoxelLabel{static_cast<std::uint8_t>(code)}};
    EXPECT_EQ(fuse_labels(only), only[0]);
  }
}

TEST(FuseCoarseLabels, TheOrderDoesNotMatter) {
  std::mt19937 random(1);
  for (unsigned i = 0; i < 2000; ++i) {
    auto labels = random_labels(random, 1 + i % 19);
    const mapping::VoxelLabel fused = fuse_labels(labels);
    std::ranges::shuffle(labels, random);
    EXPECT_EQ(fuse_labels(labels), fused);
  }
}

TEST(FuseCoarseLabels, IsTheClassThatProbabilitiesGive) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const auto labels = random_labels(random, 3);
    std::vector<ClassProbabilities> opinions;
    for (const mapping::VoxelLabel label : labels)
      opinions.push_back(mostly(label.class_id(), mapping::VoxelLabel::kProbability[label.grade()]));
    const auto exact = fuse_labels(opinions);
    EXPECT_NEAR(exact[fuse_labels(labels).class_id()], exact[label_of(exact)], 1e-4);
  }
}

TEST(FuseCoarseLabels, AgreementMakesSurerAndDisagreementLess) {
  const mapping::VoxelLabel car = mapping::VoxelLabel::of(kCar, 2), road = mapping::VoxelLabel::of(kRoad, 2);
  EXPECT_LT(fuse_labels(std::vector{car, car}).grade(), car.grade());
  EXPECT_EQ(fuse_labels(std::vector{car, car}).class_id(), kCar);
  EXPECT_GT(fuse_labels(std::vector{car, road}).grade(), car.grade());
}

TEST(LabelEntropy, IsZeroForCertaintyAndOneForNone) {
  EXPECT_NEAR(label_entropy(mostly(4, 1.0)), 0, 1e-12);
  EXPECT_NEAR(label_entropy(mostly(4, 1.0 / kClasses)), 1, 1e-12);
}

}  // namespace
}  // namespace cairn::merging
