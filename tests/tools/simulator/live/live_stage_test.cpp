// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

TEST(LiveStage, StartsWhereTheRecordingsOfTheSeedDo) {
  const auto one = LiveStage::make("corridor", 1, std::nullopt), again = LiveStage::make("corridor", 1, std::nullopt);
  ASSERT_TRUE(one && again);
  EXPECT_EQ(one->start.x, again->start.x);
  EXPECT_EQ(one->start.yaw, again->start.yaw);
  EXPECT_GT(one->plan.body_clearance(one->start.x, one->start.y, one->start.yaw), DrivenBody::kNearest);
}

TEST(LiveStage, AWishedStartNeedsRoom) {
  const auto free = LiveStage::make("corridor", 1, std::nullopt)->start;
  const auto there = LiveStage::make("corridor", 2, GroundPose{free.x, free.y, 1});
  ASSERT_TRUE(there);
  EXPECT_EQ(there->start.x, free.x);
  EXPECT_EQ(there->start.yaw, 1);
  const auto outside = LiveStage::make("corridor", 1, GroundPose{-500, 3, 0});
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(to_string(outside.error()), ::testing::HasSubstr("there is room at --start"));
}

TEST(LiveStage, UnknownScenesAreRefused) {
  EXPECT_EQ(LiveStage::make("moon", 1, std::nullopt).error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::simulator
