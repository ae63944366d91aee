// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/answers/labels_of_logits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace cairn::networks {
namespace {

/// The definition: argmax, and e^best / Σ e^x.
void expect_softmax(const std::vector<float>& logits, std::size_t channels, const LabelImage& labels) {
  const std::size_t pixels = labels.classes.size();
  for (std::size_t i = 0; i < pixels; ++i) {
    std::size_t best = 0;
    double sum = 0;
    for (std::size_t c = 1; c < channels; ++c)
      if (logits[c * pixels + i] > logits[best * pixels + i]) best = c;
    for (std::size_t c = 0; c < channels; ++c)
      sum += std::exp(static_cast<double>(logits[c * pixels + i]) - logits[best * pixels + i]);
    ASSERT_EQ(labels.classes[i], best) << i;
    ASSERT_LE(std::abs(labels.probabilities[i] - 255 / sum), 0.6) << i;
  }
}

class LabelsOfLogits : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(LabelsOfLogits, AreTheSoftmaxOfEachPixel) {
  const auto [width, height] = GetParam();
  constexpr std::size_t kChannels = 19;
  LabelImage labels;
  labels.resize(width, height);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-12, 12);
  std::vector<float> logits(kChannels * labels.classes.size());
  for (float& x : logits) x = number(random);
  labels_of_logits(logits, kChannels, ClassMap::parse("identity").value(), labels);
  expect_softmax(logits, kChannels, labels);
}

INSTANTIATE_TEST_SUITE_P(Sizes, LabelsOfLogits,
                         testing::Values(std::pair{1, 1}, std::pair{7, 5}, std::pair{64, 1}, std::pair{33, 10}));

TEST(LabelsOfLogits, OfEqualChannelsTheFirstIsTaken) {
  LabelImage labels;
  labels.resize(1, 1);
  labels_of_logits(std::vector<float>{2, 2, 2, 2}, 4, ClassMap::parse("identity").value(), labels);
  EXPECT_EQ(labels.classes[0], 0);
  EXPECT_EQ(labels.probabilities[0], 64);
}

TEST(LabelsOfLogits, AChannelWithoutAClassWinsAsNoClass) {
  LabelImage labels;
  labels.resize(1, 1);
  labels_of_logits(std::vector<float>{0, 9}, 2, ClassMap::parse("road, none").value(), labels);
  EXPECT_EQ(labels.classes[0], kNoClass);
}

TEST(LabelsOfLogits, WhatIsNotFiniteGetsNoClass) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  LabelImage labels;
  labels.resize(5, 1);
  const std::vector<float> logits{kNan, kInf, 0,    -kInf, -1e30F,  //
                                  kNan, 0,    kNan, -kInf, 1e30F};
  labels_of_logits(logits, 2, ClassMap::parse("identity").value(), labels);
  EXPECT_EQ(labels.classes, (std::vector<std::uint8_t>{kNoClass, kNoClass, 0, kNoClass, 1}));
  EXPECT_EQ(labels.probabilities[2], 255) << "what is not a number never wins";
}

}  // namespace
}  // namespace cairn::networks
