// SPDX-License-Identifier: Apache-2.0
// Clients of the command socket, the drive and the safety task, and simulated motors on a bus.
#include "onboard/app/tasks/drive_task.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "drivers/drive/canopen/canopen.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "drivers/drive/canopen/cia402_master.hpp"
#include "tests/faults/core_rig.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;
using clients::Command;
using Outcome = clients::Answer::Outcome;

class DriveTaskTest : public ::testing::Test {
 protected:
  DriveTaskTest() {
    rig_.asks_to_drive = false;
    rig_.go(1s);
    rig_.commands.keep_answers = true;
  }
  [[nodiscard]] const clients::Answer& last() const { return rig_.commands.answers.back().answer; }
  void say(std::uint16_t client, Command::Verb verb) {
    rig_.commands.say(client, rig_.bus.now, {.verb = verb, .epoch = rig_.decision().epoch, .who = {}});
  }
  void drive_for(Duration length, double v) {
    for (const Time end = rig_.bus.now + length; rig_.bus.now < end; rig_.go(20ms))
      rig_.commands.drive(rig_.bus.now, v);
  }

  faults::CoreRig rig_;
};

TEST_F(DriveTaskTest, TheWheelsFollowTheClient) {
  EXPECT_LT(rig_.left_speed(), 1e-9);
  drive_for(1s, 0.3);
  EXPECT_NEAR(rig_.left_speed(), 0.3, 0.01);
  EXPECT_EQ(last().outcome, Outcome::kDone);
  rig_.go(1s);
  EXPECT_LT(rig_.left_speed(), 1e-9) << "the client has gone silent";
}

TEST_F(DriveTaskTest, AStopOfAnyClientIsLatched) {
  drive_for(1s, 0.3);
  say(2, Command::Verb::kStop);
  rig_.go(faults::CoreRig::kTick);
  EXPECT_TRUE(last().stopped);
  drive_for(2s, 0.3);
  EXPECT_LT(rig_.left_speed(), 1e-9);
  EXPECT_EQ(rig_.decision().mode, safety::Mode::kStop);
  EXPECT_EQ(last().outcome, Outcome::kHeld);
  say(1, Command::Verb::kArm);
  rig_.go(1s);
  EXPECT_EQ(last().outcome, Outcome::kDone);
  EXPECT_LT(rig_.left_speed(), 1e-9) << "nothing was asked for since";
  drive_for(1s, 0.3);
  EXPECT_NEAR(rig_.left_speed(), 0.3, 0.01);
}

TEST_F(DriveTaskTest, OthersCanSeeTheStatusOfTheDrive) {
  LatestValue<std::optional<DriveStatus>> status;
  rig_.drive_task().publish_to(status);
  drive_for(100ms, 0.3);
  ASSERT_TRUE(status.refresh());
  ASSERT_TRUE(status.value());
  EXPECT_EQ(status.value()->level, DriveLevel::kNormal);
  say(2, Command::Verb::kStop);
  rig_.go(100ms);
  ASSERT_TRUE(status.refresh());
  EXPECT_EQ(status.value()->level, DriveLevel::kStop);
  EXPECT_EQ(status.value()->cause, DriveCause::kRequested);
}

TEST_F(DriveTaskTest, ArmingWithThePressedEStopIsRefused) {
  rig_.line.move(false, rig_.bus.now);
  rig_.go(500ms);
  say(1, Command::Verb::kArm);
  rig_.go(20ms);
  EXPECT_EQ(last().outcome, Outcome::kRefused);
  EXPECT_EQ(last().why.view(), "estop_open");
}

TEST_F(DriveTaskTest, WhatTheDriveCannotDoIsTold) {
  drive_for(100ms, 5);
  EXPECT_EQ(last().outcome, Outcome::kLimited);
  EXPECT_LT(last().v, 5);
  EXPECT_GT(last().v, 0);
}

/// From the arrival of a velocity to the first frame on the bus that has it. A control period is that of the frames to
/// the motors: the SYNC of CiA 402.
TEST_F(DriveTaskTest, ACommandIsOnTheBusWithinTwoControlPeriods) {
  constexpr Duration kControl = drive::cia402::Master::kSyncPeriod;
  drive_for(1s, 0.3);
  std::mt19937 random(7);
  std::uniform_int_distribution<int> ticks(6, 20);
  Duration worst{}, sum{};
  constexpr int kCommands = 10'000;
  for (int i = 0; i < kCommands; ++i) {
    rig_.go(ticks(random) * faults::CoreRig::kTick);
    const Time asked = rig_.bus.now;
    rig_.commands.drive(asked, 0.2 + 0.1 * (i % 3));
    const auto wanted = static_cast<std::int32_t>(std::lround((0.2 + 0.1 * (i % 3)) / 0.16 * 1000));
    bool sent = false;
    rig_.sees = [&](const drive::CanFrame& frame) {
      if (!frame.is(drive::canopen::kRpdo1 + 1)) return;
      const auto order = drive::cia402::decode_rpdo1(frame);
      sent = sent || (order && std::abs(order->target_velocity - wanted) <= 2);
    };
    while (!sent && rig_.bus.now - asked < 1s) rig_.go(faults::CoreRig::kTick);
    rig_.sees = nullptr;
    worst = std::max(worst, rig_.bus.now - asked);
    sum += rig_.bus.now - asked;
    rig_.commands.answers.clear();
  }
  RecordProperty("worst_ms", std::to_string(1e3 * to_seconds(worst)));
  RecordProperty("mean_ms", std::to_string(1e3 * to_seconds(sum) / kCommands));
  EXPECT_LE(worst, 2 * kControl);
}

/// Whether the input of a robot without a drive has ended, while clients may still command.
bool ended(bool moves) {
  support::CommandQueue commands;
  DriveTask task;
  task.obey_commands(commands, SourceId{0}, &commands, {}, moves);
  scheduler::TickRecord record;
  scheduler::Tick tick(scheduler::Regime::kLive, Time{1s}, record);
  task.tick(tick);
  return tick.ended();
}

TEST(DriveTask, APlayedRecordingEndsThoughClientsMayCommand) {
  EXPECT_TRUE(ended(false));
  EXPECT_FALSE(ended(true)) << "a robot goes on";
}

}  // namespace
}  // namespace cairn::app
