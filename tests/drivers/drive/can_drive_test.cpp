// SPDX-License-Identifier: Apache-2.0
// The CiA 402 master against simulated motor controllers, in virtual time.
#include "drivers/drive/can_drive.hpp"

#include <gtest/gtest.h>

#include "drivers/drive/canopen/cia402_master.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"

namespace cairn::drive {
namespace {

using test::Robot;
using test::two_nodes;
using namespace std::chrono_literals;

const cia402::Master& master(const Robot& robot) {
  return dynamic_cast<const cia402::Master&>(robot.drive->protocol());
}

TEST(CanDrive, BringsBothNodesUp) {
  Robot robot;
  robot.bus.power_on();
  robot.run(1s);
  for (auto& node : robot.bus.nodes) {
    EXPECT_EQ(node.nmt(), canopen::NmtState::kOperational);
    EXPECT_EQ(node.object(cia402::kConsumerHeartbeat), 127U << 16U | 100U);
    EXPECT_EQ(node.object(cia402::kAbortConnection), cia402::kReactQuickStop);
    EXPECT_EQ(node.object(cia402::kMode), 3U);
    EXPECT_NE(node.state(), cia402::State::kOperationEnabled) << "nobody armed it";
  }
  EXPECT_TRUE(robot.drive->protocol().status().ready);
  EXPECT_EQ(robot.status().cause, DriveCause::kNotArmed);
  ASSERT_TRUE(robot.arm());
  robot.run(300ms);
  for (auto& node : robot.bus.nodes) EXPECT_EQ(node.state(), cia402::State::kOperationEnabled);
  EXPECT_EQ(robot.status().level, DriveLevel::kHold);
  EXPECT_EQ(robot.status().cause, DriveCause::kNoCommand);
}

TEST(CanDrive, WaitsForNodesThatArePoweredLater) {
  Robot robot;
  robot.run(5s);
  EXPECT_FALSE(robot.arm());
  EXPECT_NE(master(robot).nodes()[0].failure(), "");
  robot.bus.power_on();
  robot.run(3s);
  EXPECT_TRUE(robot.arm());
}

TEST(CanDrive, DrivesAndMeasures) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0.4);
  robot.run(3s);
  EXPECT_EQ(robot.status().level, DriveLevel::kNormal);
  EXPECT_NEAR(robot.left_speed(), 0.4, 1e-3);
  EXPECT_NEAR(robot.right_speed(), 0.6, 1e-3);
  ASSERT_TRUE(robot.newest);
  EXPECT_NEAR(robot.newest->v, 0.5, 0.01);
  EXPECT_NEAR(robot.newest->w, 0.4, 0.02);
  const double left = robot.bus.nodes[0].angle() * 0.16, right = -robot.bus.nodes[1].angle() * 0.16;
  EXPECT_NEAR(robot.newest->T_odom_base.mean.xyz_rpy()[5], (right - left) / 0.5, 0.02);
}

TEST(CanDrive, LimitsKeepTheCurvature) {
  Robot robot;
  robot.start();
  robot.go(3, 1);
  robot.run(4s);
  EXPECT_NEAR(robot.left_speed() + robot.right_speed(), 3, 0.01);
  EXPECT_NEAR((robot.right_speed() - robot.left_speed()) / 0.5, 0.5, 0.01);
}

TEST(CanDrive, RefusesToEnableWithoutScale) {
  for (double Config::*key : {&Config::velocity_units_per_rad_s, &Config::position_counts_per_rad,
                              &Config::wheel_radius_m, &Config::wheel_separation_m}) {
    Config config = two_nodes();
    config.*key = 0;
    Robot robot(config);
    robot.bus.power_on();
    robot.run(2s);
    const auto armed = robot.drive->arm(robot.bus.now);
    ASSERT_FALSE(armed);
    EXPECT_EQ(armed.error().code, Errc::kInvalidConfig);
    robot.run(500ms);
    for (auto& node : robot.bus.nodes) EXPECT_NE(node.state(), cia402::State::kOperationEnabled);
  }
}

TEST(CanDrive, RefusesAnotherProduct) {
  Config config = two_nodes();
  config.product = 0x4645;
  Robot robot(config);
  robot.bus.power_on();
  robot.run(600ms);
  EXPECT_FALSE(robot.arm());
  EXPECT_EQ(master(robot).nodes()[0].failed_object(), cia402::kProduct);
}

TEST(CanDrive, CommandsEndAfterHalfASecond) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.wanted.reset();
  robot.run(480ms);
  EXPECT_EQ(robot.status().level, DriveLevel::kNormal);
  robot.run(1s);
  EXPECT_EQ(robot.status().cause, DriveCause::kNoCommand);
  EXPECT_EQ(robot.left_speed(), 0);
  EXPECT_EQ(robot.bus.nodes[0].state(), cia402::State::kOperationEnabled) << "a hold keeps the motors on";
  robot.go(0.5, 0);
  robot.run(1s);
  EXPECT_NEAR(robot.left_speed(), 0.5, 1e-3) << "and ends by itself";
}

TEST(CanDrive, StopIsLatchedAndOldCommandsAreDiscarded) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  const std::size_t before = robot.bus.sent.size();
  robot.drive->stop(DriveCause::kEmergencyStop, robot.bus.now);
  ASSERT_GT(robot.bus.sent.size(), before) << "the zero does not wait for a tick";
  EXPECT_EQ(cia402::decode_rpdo1(robot.bus.sent[before]).value(), (cia402::WheelOrder{cia402::kQuickStop, 0}));
  robot.run(2s);
  EXPECT_EQ(robot.status().cause, DriveCause::kEmergencyStop);
  EXPECT_EQ(robot.left_speed(), 0);
  for (auto& node : robot.bus.nodes) EXPECT_EQ(node.state(), cia402::State::kSwitchOnDisabled);
  const std::uint32_t old = robot.epoch;
  robot.wanted.reset();
  ASSERT_TRUE(robot.arm());
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(robot.drive->command({0.5, 0, old}, robot.bus.now));
    robot.run(5ms);
    EXPECT_EQ(robot.left_speed(), 0);
  }
  robot.go(0.5, 0);
  robot.run(1s);
  EXPECT_NEAR(robot.left_speed(), 0.5, 1e-3);
}

TEST(CanDrive, MotorFaultStopsAndArmingResetsIt) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.bus.deliver([&](auto& out) { robot.bus.nodes[1].fail(0x2310, out); });
  robot.run(20ms);
  EXPECT_EQ(robot.status().cause, DriveCause::kMotorFault);
  robot.run(2s);
  EXPECT_EQ(robot.left_speed(), 0);
  EXPECT_EQ(robot.bus.nodes[1].state(), cia402::State::kFault) << "never reset by itself";
  EXPECT_EQ(master(robot).nodes()[1].error_code(), 0x2310);
  ASSERT_TRUE(robot.arm());
  robot.run(2s);
  EXPECT_NEAR(robot.right_speed(), 0.5, 1e-3);
}

TEST(CanDrive, AFaultThatStaysKeepsTheDriveStopped) {
  Robot robot;
  robot.start();
  robot.bus.deliver([&](auto& out) { robot.bus.nodes[1].fail(0x5000, out, true); });
  robot.run(1s);
  robot.go(0.5, 0);
  ASSERT_TRUE(robot.arm());
  robot.run(3s);
  EXPECT_EQ(robot.status().cause, DriveCause::kEnableFailed);
  EXPECT_EQ(robot.left_speed(), 0);
}

TEST(CanDrive, ANodeThatStartsAnewIsAFault) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.bus.deliver([&](auto& out) { robot.bus.nodes[0].power_on(robot.bus.now, out); });
  robot.run(10ms);
  EXPECT_EQ(robot.status().cause, DriveCause::kMotorReset);
  robot.run(3s);
  EXPECT_EQ(robot.right_speed(), 0);
  EXPECT_EQ(robot.bus.nodes[0].nmt(), canopen::NmtState::kOperational) << "configured again, but not enabled";
  EXPECT_NE(robot.bus.nodes[0].state(), cia402::State::kOperationEnabled);
  ASSERT_TRUE(robot.arm());
  robot.run(2s);
  EXPECT_NEAR(robot.left_speed(), 0.5, 1e-3);
}

TEST(CanDrive, SilentNodesHoldThenStop) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.bus.nodes[0].mute(true);
  robot.run(90ms);
  EXPECT_EQ(robot.status().level, DriveLevel::kNormal);
  robot.run(40ms);
  EXPECT_EQ(robot.status().cause, DriveCause::kFeedbackLate);
  EXPECT_EQ(robot.bus.nodes[1].state(), cia402::State::kOperationEnabled);
  robot.run(140ms);
  EXPECT_EQ(robot.status().cause, DriveCause::kFeedbackLost);
  robot.run(2s);
  EXPECT_EQ(robot.left_speed(), 0) << "by its own watchdog: it hears no heartbeat either";
  EXPECT_EQ(robot.right_speed(), 0);
}

TEST(CanDrive, ADeadHostStopsTheNodes) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  const Time dead = robot.bus.now;
  while (robot.left_speed() > 0.499 && robot.bus.now < dead + 1s) robot.bus.advance(1ms);
  EXPECT_LE(robot.bus.now - dead, 130ms);
  while (robot.left_speed() > 0 && robot.bus.now < dead + 2s) robot.bus.advance(1ms);
  EXPECT_LE(robot.bus.now - dead, 400ms) << "watchdog and 0.5 m/s at 3 m/s²";
}

}  // namespace
}  // namespace cairn::drive
