// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "drivers/velodyne/lidar.hpp"
#include "tests/tools/simulator/live/live_robot.hpp"

namespace cairn::simulator {
namespace {

using test::LiveRobot;
using namespace std::chrono_literals;

TEST(LiveWorld, TheRobotGoesWhereItsDriveIsTold) {
  LiveRobot robot;
  robot.arm();
  EXPECT_EQ(robot.drive->status().level, DriveLevel::kHold) << "no command yet";
  robot.go(0.5, 0);
  robot.run(4s);
  EXPECT_EQ(robot.drive->status().level, DriveLevel::kNormal);
  // 1 m/s² up to 0.5 m/s costs an eighth of a metre; some ticks pass before the motors hear of it.
  EXPECT_NEAR(robot.world->body().at().x, 4 + 2 - 0.125, 0.05);
  EXPECT_NEAR(robot.world->body().at().y, 3, 1e-3);
  robot.go(0, 0.5);
  robot.run(5s);
  EXPECT_GT(robot.world->body().at().yaw, 0.5 * 5 - 0.3);
  ASSERT_TRUE(robot.newest);
  const SE3 told = robot.newest->T_odom_base.mean;
  EXPECT_NEAR(told.translation().x() + 4, robot.world->body().at().x, 0.02) << "wheels that are as measured do not lie";
  EXPECT_NEAR(told.xyz_rpy()[5], robot.world->body().at().yaw, 0.02);
  EXPECT_THAT(robot.said, ::testing::IsEmpty());
}

TEST(LiveWorld, WheelsAreNotQuiteAsTheirOwnerMeasured) {
  LiveRobot robot({4, 3, 0}, WheelConfig{});
  robot.arm();
  robot.go(1, 0);
  robot.run(4s);
  const double told = robot.newest->T_odom_base.mean.translation().x(), truly = robot.world->body().at().x - 4;
  EXPECT_GT(truly, 3);
  EXPECT_GT(std::abs(told - truly), 1e-3);
  EXPECT_NEAR(told, truly, 0.03 * truly);
}

TEST(LiveWorld, MotorsStopByThemselvesWhenTheProgramHangs) {
  LiveRobot robot;
  robot.arm();
  robot.go(1, 0);
  robot.run(2s);
  robot.silent = true;
  robot.run(1s);
  EXPECT_EQ(robot.world->motors().nodes()[0].speed(), 0);
  const double stopped = robot.world->body().at().x;
  robot.run(1s);
  EXPECT_EQ(robot.world->body().at().x, stopped);
}

TEST(LiveWorld, AStopIsFollowedWithinAMillisecond) {
  LiveRobot robot;
  robot.arm();
  robot.go(1, 0);
  robot.run(2s);
  robot.wanted.reset();
  robot.drive->stop(DriveCause::kEmergencyStop, robot.clock.now());
  robot.run(1ms);
  EXPECT_EQ(robot.world->motors().nodes()[0].state(), drive::cia402::State::kQuickStopActive);
  robot.run(1s);
  EXPECT_EQ(robot.world->motors().nodes()[0].speed(), 0);
}

/// What came meanwhile counts when it was sent: no watchdog bites because the simulator slept.
TEST(LiveWorld, ASleepOfTheSimulatorIsCaughtUpWith) {
  LiveRobot awake, sleeper;
  for (LiveRobot* robot : {&awake, &sleeper}) {
    robot->arm();
    robot->go(1, 0);
    robot->run(2s);
  }
  awake.run(90ms);
  sleeper.stall(90ms);
  awake.run(1s);
  sleeper.run(1s);
  EXPECT_EQ(sleeper.drive->status().level, DriveLevel::kNormal);
  EXPECT_NEAR(sleeper.world->body().at().x, awake.world->body().at().x, 1e-3);
}

TEST(LiveWorld, PacketsComeAsTheSensorSendsThem) {
  LiveRobot robot;
  robot.run(1s);
  const auto data = std::ranges::count(robot.packets, velodyne::kDefaultDataPort, &Packet::channel);
  EXPECT_NEAR(static_cast<double>(data), 1e9 / 1'327'104, 2) << "a VLP-16 sends one packet every 1.327 ms";
  EXPECT_EQ(std::ranges::count(robot.packets, velodyne::kDefaultPositionPort, &Packet::channel), (data + 13) / 14);
  EXPECT_EQ(robot.world->lidar().counters().data_packets, static_cast<std::uint64_t>(data));
  EXPECT_LE(robot.world->lidar().late().max(), 1ms) << "no more than a step of the world";
}

TEST(LiveWorld, TheLidarSeesTheWorldFromWhereTheRobotIs) {
  LiveRobot robot({4, 3, 0}, LiveRobot::exact(), LidarConfig{});
  robot.arm();
  robot.go(1, 0);
  robot.run(3s);
  robot.packets.clear();
  robot.go(0, 0);
  robot.run(2s);
  robot.packets.clear();
  robot.run(400ms);
  Monitor monitor;
  const auto decoder = velodyne::Lidar::create({}, SourceId{0}, monitor).value();
  const Scan* scan = nullptr;
  for (const Packet& packet : robot.packets)
    if (const auto decoded = decoder->decode(packet); decoded && *decoded != nullptr) scan = *decoded;
  ASSERT_NE(scan, nullptr);
  double ahead = 0;
  for (const Eigen::Vector3f& point : scan->cloud.xyz)
    if (std::abs(point.y()) < 0.1F && std::abs(point.z()) < 0.3F)
      ahead = std::max(ahead, static_cast<double>(point.x()));
  const double wall = 20 - (robot.world->body().at().x + 0.2);  // the sensor is 0.2 m before base_link
  EXPECT_NEAR(ahead, wall, 0.15);
}

TEST(LiveWorld, ItStopsAtWallsAndSaysSoOnce) {
  LiveRobot robot({2, 3, std::numbers::pi});
  robot.arm();
  robot.go(1, 0);
  robot.run(5s);
  EXPECT_NEAR(robot.world->body().at().x, Body::kLength / 2, 0.15);
  ASSERT_EQ(robot.said.size(), 1U);
  EXPECT_THAT(robot.said[0], ::testing::HasSubstr("run into something"));
  robot.go(-1, 0);
  robot.run(4s);
  EXPECT_GT(robot.world->body().at().x, 2) << "it can drive away";
  EXPECT_EQ(robot.said.size(), 1U);
}

TEST(LiveWorld, LatenessIsSaidOnceASecondAndTimeIsNotStretched) {
  LiveRobot robot;
  robot.run(1s);
  for (int i = 0; i < 10; ++i) {
    robot.stall(300ms);
    robot.run(10ms);
  }
  EXPECT_GE(robot.world->now(), robot.clock.now() - 1ms);
  EXPECT_GT(robot.world->lidar().counters().left_out, 1000U);
  EXPECT_GE(robot.said.size(), 2U);
  EXPECT_LE(robot.said.size(), 4U);
  EXPECT_THAT(robot.said[0], ::testing::HasSubstr("late"));
}

TEST(LiveWorld, ANetworkThatRefusesIsSaidAndDoesNotEndTheWorld) {
  LiveRobot robot;
  robot.network_down = true;
  robot.run(3s);
  EXPECT_EQ(robot.said.size(), 1U);
  EXPECT_THAT(robot.said[0], ::testing::HasSubstr("no network"));
  EXPECT_GT(robot.world->lidar().counters().refused, 2000U);
  EXPECT_EQ(robot.world->lidar().counters().data_packets, 0U);
}

TEST(LiveWorld, TheTruthIsToldAHundredTimesASecond) {
  LiveRobot robot;
  robot.arm();
  robot.go(1, 0.3);
  robot.run(2s);
  ASSERT_NEAR(static_cast<double>(robot.truth.size()), 350, 1);
  for (std::size_t i = 1; i < robot.truth.size(); ++i)
    EXPECT_EQ(robot.truth[i].first - robot.truth[i - 1].first, LiveWorld::kTruthEvery);
  EXPECT_NEAR(robot.truth.back().second[0], robot.world->body().at().x, 0.02);
  EXPECT_NEAR(robot.truth.back().second[2], Body::kBaseHeight, 1e-6);
}

TEST(LiveWorld, TheSameCommandsAtTheSameTimesGiveTheSameBytes) {
  LiveRobot one({4, 3, 0}, WheelConfig{}, LidarConfig{}), two({4, 3, 0}, WheelConfig{}, LidarConfig{});
  for (LiveRobot* robot : {&one, &two}) {
    robot->arm();
    robot->go(0.7, -0.4);
    robot->run(1s);
  }
  ASSERT_EQ(one.packets.size(), two.packets.size());
  for (std::size_t i = 0; i < one.packets.size(); ++i) EXPECT_EQ(one.packets[i].bytes, two.packets[i].bytes);
}

TEST(LiveWorld, PlayWaitsForWhatIsDueNext) {
  LiveRobot robot;
  std::vector<Time> waits;
  play(
      *robot.world,
      [&](Time until) {
        waits.push_back(until);
        robot.clock.advance_to(until);
      },
      [&] { return robot.world->now() >= robot.world->start() + 20ms; });
  EXPECT_GE(waits.size(), 20U);
  EXPECT_LE(waits.size(), 40U);
  for (std::size_t i = 1; i < waits.size(); ++i) EXPECT_GT(waits[i], waits[i - 1]) << "never twice for the same";
}

TEST(LiveWorld, ALateWorldHasSentWhatIsDueWhenItEnds) {
  LiveRobot robot;
  play(
      *robot.world, [&](Time until) { robot.clock.advance_to(until + 5ms); },
      [&] { return robot.world->now() >= robot.world->start() + 90ms; });
  EXPECT_NEAR(static_cast<double>(robot.world->lidar().counters().data_packets), 90e6 / 1'327'104, 5);
  EXPECT_EQ(robot.world->lidar().counters().left_out, 0U);
}

}  // namespace
}  // namespace cairn::simulator
