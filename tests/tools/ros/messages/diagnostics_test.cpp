// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/diagnostics.hpp"

#include <gtest/gtest.h>

namespace cairn::ros {
namespace {

using clients::RobotMode;
using std::chrono::seconds;

Time after(int s) { return Time{seconds(s)}; }

clients::StateMessage state_of(RobotMode mode, std::string cause = {}) {
  clients::StateMessage state;
  state.stamp = after(100);
  state.mode = mode;
  state.cause = std::move(cause);
  return state;
}

DiagnosticLevel mode_level(const clients::StateMessage& state) {
  Health health;
  health.core_came();
  health.take(state);
  return health.diagnoses(Time{})[1].level;
}

TEST(RosHealth, OfEachModeHasItsLevel) {
  EXPECT_EQ(mode_level(state_of(RobotMode::kNormal)), DiagnosticLevel::kOk);
  EXPECT_EQ(mode_level(state_of(RobotMode::kDegraded, "lidar_silent")), DiagnosticLevel::kWarn);
  EXPECT_EQ(mode_level(state_of(RobotMode::kHold, "lidar_silent")), DiagnosticLevel::kWarn);
  EXPECT_EQ(mode_level(state_of(RobotMode::kStop)), DiagnosticLevel::kWarn) << "it waits to be armed";
  EXPECT_EQ(mode_level(state_of(RobotMode::kStop, "estop")), DiagnosticLevel::kError);
}

TEST(RosHealth, OfOdometryIsThatOfTheLastPose) {
  Health health;
  health.core_came();
  EXPECT_EQ(health.diagnoses(Time{})[2].level, DiagnosticLevel::kStale) << "no pose yet";
  clients::PoseMessage pose;
  health.take(pose);
  EXPECT_EQ(health.diagnoses(Time{})[2].level, DiagnosticLevel::kOk);
  pose.degenerate_directions = 1;
  health.take(pose);
  EXPECT_EQ(health.diagnoses(Time{})[2].level, DiagnosticLevel::kWarn);
  pose.lost = true;
  health.take(pose);
  EXPECT_EQ(health.diagnoses(Time{})[2].level, DiagnosticLevel::kError);
}

TEST(RosHealth, AStageWarnsForTenSecondsAfterAnEvent) {
  Health health;
  health.core_came();
  health.take(state_of(RobotMode::kNormal));
  health.take(clients::EventMessage{.stamp = after(85), .count = 4, .stage = "odometry", .what = "scan refused"});
  EXPECT_EQ(health.diagnoses(Time{}).back().level, DiagnosticLevel::kOk);
  EXPECT_EQ(health.diagnoses(Time{}).back().name, "stage odometry");
  ASSERT_EQ(health.diagnoses(Time{}).back().values.size(), 1U);
  EXPECT_EQ(health.diagnoses(Time{}).back().values[0].second, "4");
  health.take(clients::EventMessage{.stamp = after(95), .count = 1, .stage = "odometry", .what = "lost"});
  EXPECT_EQ(health.diagnoses(Time{}).back().level, DiagnosticLevel::kWarn);
  EXPECT_EQ(health.diagnoses(Time{}).back().message, "lost");
}

TEST(RosHealth, ManyKindsOfEventsTakeBoundedMemory) {
  Health health;
  for (int i = 0; i < 1000; ++i)
    health.take(clients::EventMessage{.count = 1, .stage = "s" + std::to_string(i), .what = "w"});
  EXPECT_EQ(health.diagnoses(Time{}).size(), 3U + 256U);
}

TEST(RosHealth, AllIsStaleWithoutACore) {
  Health health;
  for (const Diagnosis& diagnosis : health.diagnoses(Time{})) EXPECT_EQ(diagnosis.level, DiagnosticLevel::kStale);
  health.core_came();
  health.take(state_of(RobotMode::kNormal));
  health.take(clients::PoseMessage{});
  for (const Diagnosis& diagnosis : health.diagnoses(Time{})) EXPECT_EQ(diagnosis.level, DiagnosticLevel::kOk);
  for (const Diagnosis& diagnosis : health.diagnoses(after(3))) EXPECT_EQ(diagnosis.level, DiagnosticLevel::kStale);
  health.heard(after(1));
  for (const Diagnosis& diagnosis : health.diagnoses(after(3))) EXPECT_EQ(diagnosis.level, DiagnosticLevel::kOk);
  health.core_gone();
  for (const Diagnosis& diagnosis : health.diagnoses(Time{})) EXPECT_EQ(diagnosis.level, DiagnosticLevel::kStale);
}

TEST(RosDiagnostics, NameTheRobot) {
  Arena arena;
  const DiagnosticArray message = diagnostics_of(
      {{.level = DiagnosticLevel::kWarn, .name = "mode", .message = "stop", .values = {{"cause", "estop"}}}}, "husky",
      after(1), seconds(9), arena);
  EXPECT_EQ(message.header.stamp.sec, 10);
  ASSERT_EQ(message.status._length, 1U);
  const DiagnosticStatus& status = message.status._buffer[0];
  EXPECT_EQ(status.level, 1U);
  EXPECT_STREQ(status.name, "husky: mode");
  EXPECT_STREQ(status.message, "stop");
  EXPECT_STREQ(status.hardware_id, "husky");
  ASSERT_EQ(status.values._length, 1U);
  EXPECT_STREQ(status.values._buffer[0].key, "cause");
  EXPECT_STREQ(status.values._buffer[0].value, "estop");
}

}  // namespace
}  // namespace cairn::ros
