// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/eye_offset.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace cairn::people {
namespace {

constexpr double kDegree = 0.0174533;

/// Five pictures a second that show one of `people` each, whose boxes are aside by 0.7° more or less, and scatter by
/// 0.5°.
void look(EyeOffset& offset, double angle, int pictures, int from = 0, std::uint32_t people = 6) {
  std::mt19937 random(static_cast<unsigned>(from));
  std::normal_distribution<double> scatter(0, 0.5 * kDegree);
  for (int i = from; i < from + pictures; ++i) {
    const auto person = static_cast<std::uint32_t>(i / 5) % people + 1;
    const double walks = person % 2 == 0 ? 0.7 : -0.7;
    const std::array boxes{BoxBeside{person, angle + walks * kDegree + scatter(random)}};
    offset.add(Time{from_seconds(0.2 * i)}, boxes);
  }
}

TEST(EyeOffset, FewPeopleSayNothing) {
  EyeOffset offset;
  look(offset, 3 * kDegree, 200, 0, EyeOffset::kLeastPeople - 1);
  EXPECT_FALSE(offset.angle());
  EXPECT_FALSE(offset.moved());
}

TEST(EyeOffset, KnowsACameraThatWasTurned) {
  for (const double turn : {-3.0, 3.0}) {
    EyeOffset offset;
    look(offset, turn * kDegree, 60);
    EXPECT_NEAR(offset.angle().value(), turn * kDegree, 0.9 * kDegree);
    EXPECT_TRUE(offset.moved());
  }
}

TEST(EyeOffset, ScatterIsNoTurn) {
  EyeOffset offset;
  for (int i = 0; i < 200; ++i) {
    look(offset, 0, 10, 10 * i);
    ASSERT_FALSE(offset.moved()) << i;
  }
}

TEST(EyeOffset, IsWellAgainWhenTheBoxesAre) {
  EyeOffset offset;
  look(offset, 3 * kDegree, 60);
  EXPECT_TRUE(offset.moved());
  look(offset, 0, 400, 60);
  EXPECT_FALSE(offset.moved());
}

TEST(EyeOffset, ForgetsAfterAMinute) {
  EyeOffset offset;
  look(offset, 2 * kDegree, 60);
  look(offset, 0, 1, 2000);
  EXPECT_FALSE(offset.angle());
}

}  // namespace
}  // namespace cairn::people
