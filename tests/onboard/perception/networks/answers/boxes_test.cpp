// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/networks/answers/boxes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cairn::networks {
namespace {

constexpr int kStrides[] = {8, 16};

TEST(ReadYolox, ARowIsACellOfAGrid) {
  // 32×16: 4×2 cells of 8 pixels, then 2×1 of 16. Two classes.
  ASSERT_EQ(yolox_rows(32, 16, kStrides), 10U);
  std::vector<float> rows(10 * 7, 0.0F);
  const auto set = [&](std::size_t row, std::vector<float> values) {
    std::copy(values.begin(), values.end(), rows.begin() + static_cast<std::ptrdiff_t>(row * 7));
  };
  set(6, {0.5F, 0.25F, std::log(2.0F), std::log(1.5F), 0.9F, 0.1F, 0.8F});  // cell (2, 1) of stride 8
  set(9, {0.5F, 0.5F, 0, 0, 0.5F, 0.9F, 0.2F});                             // cell (1, 0) of stride 16
  set(0, {0, 0, 0, 0, 0.5F, 0.5F, 0.5F});                                   // 0.25 is below the threshold
  std::vector<Candidate> found;
  read_yolox(rows, 7, 32, 16, kStrides, 0.3F, found);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_FLOAT_EQ(found[0].left, 20 - 8);
  EXPECT_FLOAT_EQ(found[0].right, 20 + 8);
  EXPECT_FLOAT_EQ(found[0].top, 10 - 6);
  EXPECT_FLOAT_EQ(found[0].bottom, 10 + 6);
  EXPECT_EQ(found[0].channel, 1U);
  EXPECT_FLOAT_EQ(found[0].score, 0.72F);
  EXPECT_FLOAT_EQ(found[1].left, 16);
  EXPECT_FLOAT_EQ(found[1].bottom, 16);
  EXPECT_EQ(found[1].channel, 0U);
}

TEST(ReadYolox, WhatIsNoNumberIsNoBox) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf, -kInf})
    for (std::size_t column = 0; column < 6; ++column) {
      std::vector<float> row{0, 0, 0, 0, 1, 1};
      row[column] = bad;
      std::vector<Candidate> found;
      read_yolox(row, 6, 8, 8, std::span(kStrides).first(1), 0.3F, found);
      for (const Candidate& c : found) {
        EXPECT_TRUE(std::isfinite(c.left) && std::isfinite(c.right) && std::isfinite(c.top) && std::isfinite(c.bottom));
        EXPECT_LE(c.score, 1.0F);
      }
    }
}

TEST(ReadSsd, RowsAndPairsGiveTheSameBoxes) {
  const std::vector<float> rows{0,  1, 0.9F, 0.25F, 0.5F, 0.75F, 1,  //
                                0,  2, 0.2F, 0,     0,    1,     1,  //
                                -1, 0, 0,    0,     0,    0,     0};
  std::vector<Candidate> one, two;
  read_ssd_rows(rows, 40, 20, 0.3F, one);
  const std::vector<float> scores{0.1F, 0.9F, 0, 0.8F, 0, 0.2F}, boxes{0.25F, 0.5F, 0.75F, 1, 0, 0, 1, 1};
  read_ssd_pair(scores, 3, boxes, 40, 20, 0.3F, two);
  ASSERT_EQ(one.size(), 1U);
  ASSERT_EQ(two.size(), 1U);
  EXPECT_FLOAT_EQ(one[0].left, 10);
  EXPECT_FLOAT_EQ(one[0].bottom, 20);
  EXPECT_EQ(one[0].channel, 1U);
  EXPECT_EQ(two[0].channel, one[0].channel);
  EXPECT_FLOAT_EQ(two[0].right, one[0].right);
}

const Placement kHalf{
    .input_width = 50, .input_height = 50, .picture_width = 100, .picture_height = 80, .scale_x = 0.5, .scale_y = 0.5};

TEST(SelectBoxes, BoxesAreInPixelsOfThePictureAndClipped) {
  std::vector<Candidate> candidates{{-5, 10, 60, 45, 0, 0.9F}, {60, 0, 70, 10, 0, 0.8F}};
  std::vector<Detection> found;
  select_boxes(candidates, ClassMap::parse("person").value(), {}, kHalf, found);
  ASSERT_EQ(found.size(), 1U) << "the other one lies outside";
  EXPECT_FLOAT_EQ(found[0].x, 0);
  EXPECT_FLOAT_EQ(found[0].y, 20);
  EXPECT_FLOAT_EQ(found[0].width, 100);
  EXPECT_FLOAT_EQ(found[0].height, 60);
  EXPECT_EQ(found[0].class_id, kPersonClass);
}

TEST(SelectBoxes, TheWeakerOfTwoOverlappingBoxesOfAClassIsDropped) {
  const auto classes = ClassMap::parse("person, car, none").value();
  std::vector<Candidate> candidates{{0, 0, 10, 10, 0, 0.5F},
                                    {0, 0, 10, 11, 0, 0.9F},
                                    {0, 0, 10, 10, 1, 0.4F},
                                    {20, 0, 30, 10, 0, 0.6F},
                                    {0, 0, 10, 10, 2, 1.0F}};
  std::vector<Detection> found;
  select_boxes(candidates, classes, {}, kHalf, found);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_FLOAT_EQ(found[0].score, 0.9F);
  EXPECT_FLOAT_EQ(found[1].score, 0.6F);
  EXPECT_EQ(kSemanticClasses[found[2].class_id].name, "car") << "another class may overlap";
}

TEST(SelectBoxes, OfEqualScoresTheEarlierIsBetter) {
  std::vector<Candidate> candidates{{0, 0, 10, 10, 0, 0.5F}, {1, 0, 11, 10, 0, 0.5F}};
  std::vector<Detection> found;
  select_boxes(candidates, ClassMap::parse("person").value(), {}, kHalf, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FLOAT_EQ(found[0].x, 0);
}

TEST(SelectBoxes, ManyBoxesAreBounded) {
  std::vector<Candidate> candidates;
  for (int i = 0; i < 100'000; ++i) {
    const auto x = static_cast<float>(i % 50), y = static_cast<float>(i / 50 % 40);
    candidates.push_back({x, y, x + 1, y + 1, 0, 0.5F});
  }
  std::vector<Detection> found;
  select_boxes(candidates, ClassMap::parse("person").value(), {}, kHalf, found);
  EXPECT_EQ(found.size(), kMaxBoxes);
}

}  // namespace
}  // namespace cairn::networks
