// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/label_evidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace cairn::mapping {
namespace {

constexpr unsigned kClasses = VoxelLabel::kClasses;

/// Bayes' rule with all 19 classes and no bounds.
struct AllClasses {
  std::array<double, kClasses> nats{};
  void add(unsigned class_id, unsigned steps) { nats[class_id] += steps * LabelEvidence::kNatsPerStep; }
  [[nodiscard]] unsigned best() const { return static_cast<unsigned>(std::ranges::max_element(nats) - nats.begin()); }
  [[nodiscard]] std::array<double, kClasses> probabilities() const {
    std::array<double, kClasses> p{};
    double sum = 0;
    for (unsigned k = 0; k < kClasses; ++k) sum += p[k] = std::exp(nats[k]);
    for (double& v : p) v /= sum;
    return p;
  }
};

unsigned below(unsigned n, std::mt19937& random) { return static_cast<unsigned>(random() % n); }

LabelEvidence random_evidence(std::mt19937& random, int observations) {
  LabelEvidence evidence;
  for (int i = 0; i < observations; ++i) evidence.add(static_cast<std::uint8_t>(below(6, random)), below(20, random));
  return evidence;
}

TEST(LabelEvidence, IsBayesRuleWhileThreeClassesAndSmallSumsAreEnough) {
  LabelEvidence evidence;
  AllClasses all;
  for (const auto& [class_id, steps] : {std::pair{13, 20}, {0, 12}, {13, 9}, {8, 5}, {0, 30}}) {
    evidence.add(static_cast<std::uint8_t>(class_id), static_cast<unsigned>(steps));
    all.add(static_cast<unsigned>(class_id), static_cast<unsigned>(steps));
  }
  const auto p = evidence.probabilities(), expected = all.probabilities();
  for (unsigned k = 0; k < kClasses; ++k) EXPECT_NEAR(p[k], expected[k], 1e-12) << k;
  EXPECT_EQ(evidence.class_id(), 0);
}

TEST(LabelEvidence, NoEvidencePrefersNothing) {
  EXPECT_EQ(LabelEvidence().id(), 0U);
  EXPECT_FALSE(LabelEvidence().label().any());
  for (const double p : LabelEvidence().probabilities()) EXPECT_DOUBLE_EQ(p, 1.0 / kClasses);
}

TEST(LabelEvidence, WhatANodeKeepsIsTheEvidence) {
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    const LabelEvidence evidence = random_evidence(random, i % 12);
    EXPECT_EQ(LabelEvidence::from_id(evidence.id()), evidence);
    EXPECT_TRUE(is_label_id(evidence.id()));
    double sum = 0;
    for (const double p : evidence.probabilities()) sum += p;
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_EQ(VoxelLabel::from_id(evidence.id()), evidence.label());
  }
}

TEST(LabelEvidence, AnyOtherIdIsNone) {
  std::mt19937 random(8);
  std::size_t accepted = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t id = static_cast<std::uint32_t>(random()) | LabelEvidence::kMark;
    const LabelEvidence evidence = LabelEvidence::from_id(id);
    EXPECT_EQ(is_label_id(id), evidence.any());
    if (!evidence.any()) continue;
    ++accepted;
    EXPECT_EQ(evidence.id(), id) << "one id for one evidence, or equal voxels would not be pruned";
  }
  EXPECT_GT(accepted, 0U);
  EXPECT_FALSE(is_label_id(VoxelLabel::kCodes + 1));
  EXPECT_TRUE(is_label_id(VoxelLabel::kCodes));
}

TEST(LabelEvidence, ALabelThatWasReceivedIsEvidenceForIt) {
  for (unsigned k = 0; k < kClasses; ++k)
    for (unsigned grade = 0; grade < VoxelLabel::kGrades; ++grade) {
      const VoxelLabel label = VoxelLabel::of(k, grade);
      EXPECT_EQ(LabelEvidence::from_id(label.code).label(), label);
    }
}

TEST(LabelEvidence, TheGradeIsTheNearestInLogits) {
  const auto logit = [](double p) { return std::log(p / (1 - p)); };
  LabelEvidence evidence;
  for (unsigned steps = 1; steps <= LabelEvidence::kMost; ++steps) {
    evidence.add(3, 1);
    const double p = evidence.probabilities()[3];
    const auto distance = [&](double grade) { return std::abs(logit(grade) - logit(p)); };
    const double chosen = distance(VoxelLabel::kProbability[evidence.label().grade()]);
    for (const double grade : VoxelLabel::kProbability) EXPECT_LE(chosen, distance(grade) + 2e-3) << steps;
  }
  EXPECT_EQ(evidence.label().grade(), 0U);
}

TEST(LabelEvidence, AChangedWorldIsBelievedInTime) {
  LabelEvidence evidence;
  for (int i = 0; i < 1000; ++i) evidence.add(13, 8);
  int observations = 0;
  for (; evidence.class_id() == 13; ++observations) evidence.add(0, 8);
  EXPECT_LE(observations, 9);
}

TEST(LabelEvidence, OverflowTakesFromTheOthers) {
  LabelEvidence evidence;
  evidence.add(1, 60);
  evidence.add(2, 50);
  evidence.add(3, 4);
  evidence.add(1, 13);
  EXPECT_EQ(evidence.entries()[0], (LabelEvidence::Entry{1, 63}));
  EXPECT_EQ(evidence.entries()[1], (LabelEvidence::Entry{2, 40}));
  EXPECT_EQ(evidence.entries()[2], LabelEvidence::Entry{}) << "4 less 10 is nothing";
}

/// Voxels of 19 classes, each seen in 5 to 40 pictures by a network that is right in seven of ten and prefers one wrong
/// class per voxel, which is what networks do.
TEST(LabelEvidence, LosesLittleAgainstAllNineteen) {
  std::mt19937 random(70001);
  std::array<double, kClasses> hit_packed{}, hit_all{}, total{};
  for (int i = 0; i < 20000; ++i) {
    const unsigned truth = below(kClasses, random), favourite = below(kClasses, random);
    LabelEvidence packed;
    AllClasses all;
    for (unsigned n = 5 + below(36, random); n > 0; --n) {
      const unsigned dice = below(10, random);
      const unsigned said = dice < 5 ? truth : dice < 8 ? favourite : below(kClasses, random);
      const unsigned steps = 1 + below(14, random);
      packed.add(static_cast<std::uint8_t>(said), steps);
      all.add(said, steps);
    }
    total[truth] += 1;
    hit_packed[truth] += packed.class_id() == truth ? 1 : 0;
    hit_all[truth] += all.best() == truth ? 1 : 0;
  }
  double packed = 0, all = 0;
  for (unsigned k = 0; k < kClasses; ++k)
    packed += hit_packed[k] / total[k] / kClasses, all += hit_all[k] / total[k] / kClasses;
  EXPECT_GT(all, 0.8);
  EXPECT_GT(packed, all - 0.005) << "packed " << packed << ", all " << all;
}

}  // namespace
}  // namespace cairn::mapping
