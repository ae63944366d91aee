// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/state.hpp"

#include <gmock/gmock.h>

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

StateMessage some_state() {
  StateMessage state;
  state.stamp = Time{Duration{9}};
  state.mode = RobotMode::kHold;
  state.cause = "lidar_silent";
  state.faults = {"lidar_silent", "overload"};
  state.arming_epoch = 5;
  state.drive = DriveStatus{DriveLevel::kHold, DriveCause::kNoCommand, 6};
  state.shed = "nothing";
  state.scans = 70;
  state.map_epoch = 1;
  return state;
}

TEST(StateMessage, ComesBackAsItWasSent) {
  const auto got = decode_state(test::body_of(some_state()));
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->stamp, Time{Duration{9}});
  EXPECT_EQ(got->mode, RobotMode::kHold);
  EXPECT_EQ(got->cause, "lidar_silent");
  EXPECT_THAT(got->faults, ::testing::ElementsAre("lidar_silent", "overload"));
  EXPECT_EQ(got->arming_epoch, 5U);
  ASSERT_TRUE(got->drive);
  EXPECT_EQ(got->drive->level, DriveLevel::kHold);
  EXPECT_EQ(got->drive->cause, DriveCause::kNoCommand);
  EXPECT_EQ(got->drive->epoch, 6U);
  EXPECT_EQ(got->shed, "nothing");
  EXPECT_EQ(got->scans, 70U);
  EXPECT_EQ(got->map_epoch, 1U);
  test::expect_exact(test::body_of(some_state()), decode_state);
}

TEST(StateMessage, ARobotMayBeInATeam) {
  StateMessage state = some_state();
  state.T_team_odom = SE3(Eigen::Quaterniond(0.8, 0, 0, 0.6), {1, -2, 3});
  const auto got = decode_state(test::body_of(state));
  ASSERT_TRUE(got) << to_string(got.error());
  ASSERT_TRUE(got->T_team_odom);
  EXPECT_EQ(got->T_team_odom->translation(), Eigen::Vector3d(1, -2, 3));
  EXPECT_EQ(got->T_team_odom->quaternion().w(), 0.8);
  EXPECT_FALSE(decode_state(test::body_of(some_state()))->T_team_odom);
  test::expect_exact(test::body_of(state), decode_state);
}

TEST(StateMessage, ARobotMayHaveNoDrive) {
  StateMessage state = some_state();
  state.drive.reset();
  const auto got = decode_state(test::body_of(state));
  ASSERT_TRUE(got);
  EXPECT_FALSE(got->drive);
}

TEST(StateMessage, IsBounded) {
  StateMessage state = some_state();
  state.faults.assign(100, std::string(100, 'f'));
  const auto got = decode_state(test::body_of(state));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->faults.size(), StateMessage::kMaxFaults);
  EXPECT_EQ(got->faults[0].size(), StateMessage::kMaxText);
}

TEST(StateMessage, HasAWordForEveryModeAndLevel) {
  EXPECT_EQ(to_string(RobotMode::kDegraded), "degraded");
  EXPECT_EQ(to_string(DriveLevel::kStop), "stop");
}

}  // namespace
}  // namespace cairn::clients
