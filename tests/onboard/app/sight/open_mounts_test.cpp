// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/sight/open_mounts.hpp"

#include <gmock/gmock.h>

namespace cairn::app {
namespace {

class OpenMounts : public ::testing::Test {
 protected:
  OpenMounts() {
    profile_.camera.driver.capture.width = 336;
    profile_.camera.driver.capture.height = 240;
    profile_.camera.driver.side_by_side = false;
    profile_.camera.intrinsics.fx = profile_.camera.intrinsics.fy = 190;
    profile_.camera.intrinsics.cx = 168;
    profile_.camera.intrinsics.cy = 120;
    sources_ = {{"lidar", recording::kVelodyne, "lidar.pcap", "lidar", "VLP-16"},
                {"camera", recording::kCamera, "camera/data.csv", "camera", ""}};
  }
  std::vector<MountParts> open() { return open_mounts(options_, profile_, sources_, monitor_); }

  RunOptions options_;
  RobotProfile profile_;
  std::vector<recording::SourceEntry> sources_;
  Monitor monitor_;
};

TEST_F(OpenMounts, ACalibratedCameraIsWatched) {
  const auto parts = open();
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].source, "camera");
  EXPECT_EQ(parts[0].period, std::chrono::milliseconds(200));
  EXPECT_TRUE(monitor_.events().empty());
}

TEST_F(OpenMounts, WhoIsNotAskedDoesNotWatch) {
  options_.networks = NetworkUse::kOff;
  EXPECT_TRUE(open().empty());
  options_.networks = NetworkUse::kRun;
  profile_.perception.mount.rate_hz = 0;
  EXPECT_TRUE(open().empty());
}

TEST_F(OpenMounts, ACameraWithoutIntrinsicsIsNotWatched) {
  profile_.camera.intrinsics.fx = profile_.camera.intrinsics.fy = 0;
  EXPECT_TRUE(open().empty());
  EXPECT_TRUE(monitor_.events().empty());
}

/// There both eyes tell the motion, whatever the profile says of a LiDAR, and no odometry of scans gives poses.
TEST_F(OpenMounts, WithoutALidarNothingIsWatched) {
  sources_.erase(sources_.begin());
  EXPECT_FALSE(profile_.sees_its_way());
  EXPECT_TRUE(open().empty());
}

/// The map does not need the camera.
TEST_F(OpenMounts, IntrinsicsThatDoNotFitAreAnEventAndNoError) {
  profile_.camera.intrinsics.width = 1280;
  profile_.camera.intrinsics.height = 720;
  EXPECT_TRUE(open().empty());
  ASSERT_EQ(monitor_.events().size(), 1U);
  EXPECT_THAT(monitor_.events()[0].what, ::testing::HasSubstr("the mount of camera is not watched: "));
}

}  // namespace
}  // namespace cairn::app
