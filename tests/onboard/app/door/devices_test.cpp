// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/devices.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "hal/monitor.hpp"
#include "onboard/app/door/door.hpp"
#include "tests/support/places.hpp"

namespace cairn::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> kinds_of(const RobotProfile& profile) {
  std::vector<std::string> kinds;
  for (const auto& entry : devices_of(profile)) kinds.emplace_back(to_string(entry.kind));
  return kinds;
}

RobotProfile shipped(const std::string& name) { return load_profile(places::source() / "config" / name).value(); }

TEST(Devices, OfTheProfilesThatWeShip) {
  EXPECT_THAT(kinds_of(RobotProfile{}), ElementsAre("velodyne"));
  EXPECT_THAT(kinds_of(shipped("husky.yaml")), ElementsAre("velodyne", "camera", "thermal", "depth", "drive", "gpio"));
  EXPECT_THAT(kinds_of(shipped("uav.yaml")), ElementsAre("camera"));
}

TEST(Devices, AreEntriesThatARecordingTakes) {
  recording::Recording r;
  r.robot = "husky";
  r.sources = devices_of(shipped("husky.yaml"));
  const auto parsed = recording::parse_recording(recording::to_yaml(r), "recording.yaml");
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  ASSERT_EQ(parsed->sources.size(), r.sources.size());
  for (std::size_t i = 0; i < r.sources.size(); ++i) {
    EXPECT_EQ(parsed->sources[i].id, r.sources[i].id);
    EXPECT_EQ(parsed->sources[i].base_sensor_xyz_rpy, r.sources[i].base_sensor_xyz_rpy);
  }
}

TEST(Devices, AMissingOneIsNamedWithItsRemedy) {
  const LiveClock clock;
  RobotProfile profile;
  profile.lidar.enabled = false;
  profile.camera.driver.capture.device = "/dev/v4l/by-id/nothing";
  auto devices = open_devices_of(profile, clock);
  ASSERT_FALSE(devices);
  EXPECT_THAT(to_string(devices.error()), HasSubstr("/dev/v4l/by-id/nothing"));
  profile.camera.driver.capture.device.clear();
  profile.drive.driver.interface = "nocan7";
  devices = open_devices_of(profile, clock);
  ASSERT_FALSE(devices);
  EXPECT_THAT(to_string(devices.error()), HasSubstr("nocan7"));
}

TEST(Devices, ThatFillNoMapAreRefused) {
  const LiveClock clock;
  Monitor monitor;
  RobotProfile profile;
  profile.lidar.maps = false;
  profile.depth.map.rate_hz = 5;
  const auto door = open_devices(profile, {}, clock, monitor);
  ASSERT_FALSE(door);
  EXPECT_THAT(to_string(door.error()), HasSubstr("depth.capture.device"));
}

}  // namespace
}  // namespace cairn::app
