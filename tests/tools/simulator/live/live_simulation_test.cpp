// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/live_simulation.hpp"

#include <gtest/gtest.h>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/scheduler/task_spec.hpp"
#include "tests/support/own_address.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::simulator {
namespace {

LiveConfig in(const support::TemporaryFolder& folder) {
  LiveConfig config;
  config.scene = "corridor";
  config.can = "unix:" + (folder / "can").string();
  config.estop = folder / "estop";
  config.truth = folder / "truth.tum";
  config.profile = folder / "robot.yaml";
  config.to = {support::own_address(), 22'468};  // and 28408; the system hands out none below 32768
  return config;
}

/// The profile alone is enough for a robot's program to find all devices.
TEST(LiveSimulation, ARobotsProgramOpensTheDevicesOfTheProfile) {
  const support::TemporaryFolder folder;
  bool tried = false;
  LiveConsole console;
  console.say = [](const std::string&) {};
  console.started = [&](const LiveDevices& devices) {
    const auto profile = app::load_profile(folder / "robot.yaml");
    ASSERT_TRUE(profile) << to_string(profile.error());
    EXPECT_EQ(profile->drive.driver.interface, devices.can);
    EXPECT_FALSE(devices.pressed);
    const LiveClock clock;
    Monitor monitor;
    const auto door = app::open_devices(*profile, {.all = true}, clock, monitor);
    ASSERT_TRUE(door) << to_string(door.error());
    EXPECT_EQ(door->recording.realtime_offset_ns % 1000, 0) << "drive.log has microseconds of UTC";
    ASSERT_EQ(door->inputs.size(), 3U);
    EXPECT_NE(door->inputs[1].can, nullptr);
    ASSERT_NE(door->inputs[2].lines, nullptr);
    EXPECT_TRUE(door->inputs[2].lines->level(gpio::Line::kEStop).value());
    tried = true;
  };
  console.stop = [&] { return tried; };
  const auto played = simulate_live(in(folder), console);
  ASSERT_TRUE(played) << to_string(played.error());
  EXPECT_TRUE(tried);
  EXPECT_FALSE(std::filesystem::exists(folder / "can"));
  EXPECT_FALSE(std::filesystem::exists(folder / "estop"));
}

TEST(LiveSimulation, EndsAfterItsSecondsAndLeavesTheTruth) {
  const support::TemporaryFolder folder;
  LiveConfig config = in(folder);
  config.seconds = 0.1;
  const LiveConsole console{[] { return false; }, [](const LiveDevices&) {}, [](const std::string&) {}};
  const auto played = simulate_live(config, console);
  ASSERT_TRUE(played) << to_string(played.error());
  EXPECT_GE(played->seconds, 0.1);
  EXPECT_GT(played->lidar.data_packets + played->lidar.left_out, 0U) << "how many depends on the machine's load";
  EXPECT_EQ(played->distance_m, 0) << "nobody drives it";
  const auto truth = recording::read_tum(folder / "truth.tum").value();
  ASSERT_FALSE(truth.empty());
  EXPECT_NEAR(truth.back().pose.translation().x(), played->end.x, 1e-6);
}

TEST(LiveSimulation, WhatCannotBeOpenedEndsItBeforeItStarts) {
  const support::TemporaryFolder folder;
  const LiveConsole console{[] { return true; }, [](const LiveDevices&) { FAIL(); }, [](const std::string&) {}};
  LiveConfig config = in(folder);
  config.to.host = "nowhere";
  EXPECT_EQ(simulate_live(config, console).error().code, Errc::kInvalidConfig);
  config = in(folder);
  config.truth = folder / "missing/truth.tum";
  EXPECT_FALSE(simulate_live(config, console));
  config = in(folder);
  config.profile = folder / "missing/robot.yaml";
  EXPECT_FALSE(simulate_live(config, console));
  EXPECT_FALSE(std::filesystem::exists(folder / "estop")) << "nothing is left";
}

TEST(LiveSimulation, WithoutRealTimeRightsSafetyAndDriveTakeTheirTime) {
  const LiveDevices devices{{}, {}, "unix:/x/can", "/x/estop", false};
  const app::RobotProfile fast = live_profile({}, devices, true), slow = live_profile({}, devices, false);
  EXPECT_EQ(fast.schedule.safety.rate_hz, app::ScheduleProfile().safety.rate_hz);
  EXPECT_LT(slow.schedule.safety.rate_hz, fast.schedule.safety.rate_hz);
  EXPECT_TRUE(scheduler::validate(slow.schedule.tasks({.perception = true, .depth = true}), 2));
}

TEST(LiveSimulation, PositionPacketsHaveAPortBesideThatOfTheData) {
  EXPECT_EQ((UdpTarget{"", 2368}.position_port()), 8308);
  EXPECT_EQ((UdpTarget{"", 65535}.position_port()), 65535 - 5940);
}

}  // namespace
}  // namespace cairn::simulator
