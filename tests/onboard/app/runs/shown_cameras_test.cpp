// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/shown_cameras.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/app/tasks/grey_pictures.hpp"

namespace cairn::app {
namespace {

using clients::CameraMessage;

recording::SourceEntry camera_entry(const char* id, recording::SensorKind kind) {
  recording::SourceEntry entry;
  entry.id = id;
  entry.kind = kind;
  return entry;
}

TEST(ShownCameras, AreThoseOfTheRunAsTheProfileDescribesThem) {
  RobotProfile profile;
  profile.camera.driver.side_by_side = true;
  profile.camera.driver.latency_ms = 30;
  profile.camera.driver.capture.width = 1344;
  profile.camera.driver.capture.height = 376;
  profile.camera.intrinsics.fx = profile.camera.intrinsics.fy = 350;
  profile.camera.intrinsics.cx = 336;
  profile.camera.intrinsics.cy = 188;
  profile.camera.intrinsics.k1 = -0.1;
  profile.camera.intrinsics.baseline_m = 0.12;
  const std::vector sources{camera_entry("lidar", recording::kVelodyne),
                            camera_entry("camera_right", recording::kCamera), camera_entry("front", recording::kCamera),
                            camera_entry("thermal", recording::kThermal)};
  const auto cameras = shown_cameras(profile, sources);
  ASSERT_EQ(cameras.size(), 2U);
  const CameraMessage& front = cameras[0].message;
  EXPECT_EQ(front.name, "front");
  EXPECT_EQ(front.camera, 0);
  EXPECT_EQ(front.width, 672U);
  EXPECT_TRUE(front.side_by_side);
  EXPECT_EQ(front.lens, CameraMessage::Lens::kRadTan);
  EXPECT_EQ(front.k[0], -0.1);
  EXPECT_EQ(front.baseline_m, 0.12);
  EXPECT_EQ(cameras[0].latency, std::chrono::milliseconds(30));
  EXPECT_EQ(cameras[1].message.camera, 1);
  EXPECT_EQ(cameras[1].message.lens, CameraMessage::Lens::kUnknown) << "it is not calibrated";
}

TEST(ShownCameras, PicturesAreHandedOnOnlyWhileTheyAreWanted) {
  Monitor monitor;
  ReceiveTask receive(monitor);
  Input input;
  input.entry = camera_entry("camera", recording::kCamera);
  input.source = std::make_unique<grey::Pictures>(grey::pictures(10));
  ASSERT_TRUE(receive.add(input, SourceId{}, {}));
  StreamOutlets outlets;
  const std::vector<ShownCamera> cameras = shown_cameras(RobotProfile(), std::vector{input.entry});
  show(cameras, receive, outlets);
  const auto tick_at = [&](int picture) {
    scheduler::TickRecord record;
    scheduler::Tick tick(scheduler::Regime::kVirtual, grey::picture(picture).arrival, record);
    receive.tick(tick);
  };
  PictureOutlet& outlet = outlets.pictures[0];
  tick_at(2);
  EXPECT_EQ(outlet.pictures.size(), 0U);
  outlet.wanted = true;
  tick_at(9);
  EXPECT_EQ(outlet.pictures.size(), 2U) << "who does not keep up gets fewer";
  EXPECT_EQ(outlet.pictures.front()->bytes, grey::picture(3).bytes);
}

}  // namespace
}  // namespace cairn::app
