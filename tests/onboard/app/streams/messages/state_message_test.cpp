// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/messages/state_message.hpp"

#include <gmock/gmock.h>

namespace cairn::app {
namespace {

StateNews silent_lidar() {
  StateNews news;
  news.decision.mode = safety::Mode::kHold;
  news.decision.cause = safety::Fault::kLidarSilent;
  news.decision.active = {safety::Fault::kLidarSilent, safety::Fault::kOverload};
  news.decision.epoch = 4;
  news.shed = safety::Shed::kMapDensity;
  news.scans = 12;
  news.drive = DriveStatus{DriveLevel::kHold, DriveCause::kNoCommand, 2};
  return news;
}

TEST(StateMessageOfNews, SaysItAll) {
  clients::StateMessage message;
  message.map_epoch = 9;
  EXPECT_TRUE(update(silent_lidar(), message));
  EXPECT_EQ(message.mode, clients::RobotMode::kHold);
  EXPECT_EQ(message.cause, to_string(safety::Fault::kLidarSilent));
  EXPECT_THAT(message.faults,
              ::testing::ElementsAre(to_string(safety::Fault::kLidarSilent), to_string(safety::Fault::kOverload)));
  EXPECT_EQ(message.arming_epoch, 4U);
  EXPECT_EQ(message.shed, to_string(safety::Shed::kMapDensity));
  EXPECT_EQ(message.scans, 12U);
  EXPECT_EQ(message.map_epoch, 9U);
  ASSERT_TRUE(message.drive);
  EXPECT_EQ(message.drive->cause, DriveCause::kNoCommand);
}

TEST(StateMessageOfNews, APlaceInTheTeamIsToldWhenItChanges) {
  clients::StateMessage message;
  StateNews news = silent_lidar();
  EXPECT_TRUE(update(news, message));
  EXPECT_FALSE(message.T_team_odom);
  news.T_team_odom = SE3(Eigen::Quaterniond::Identity(), {1, 2, 3});
  EXPECT_TRUE(update(news, message));
  ASSERT_TRUE(message.T_team_odom);
  EXPECT_EQ(message.T_team_odom->translation().y(), 2);
  EXPECT_FALSE(update(news, message));
  news.T_team_odom = SE3(Eigen::Quaterniond::Identity(), {1, 2, 3.5});
  EXPECT_TRUE(update(news, message));
}

TEST(StateMessageOfNews, AFurtherScanIsNoChange) {
  clients::StateMessage message;
  EXPECT_TRUE(update(silent_lidar(), message));
  StateNews news = silent_lidar();
  ++news.scans;
  EXPECT_FALSE(update(news, message));
  EXPECT_EQ(message.scans, 13U);
  news.drive.reset();
  EXPECT_TRUE(update(news, message));
}

}  // namespace
}  // namespace cairn::app
