// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/robot_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

TEST(RobotProfile, EveryProfileInConfigIsValid) {
  int profiles = 0;
  for (const auto& file : std::filesystem::directory_iterator(places::source() / "config")) {
    if (file.path().extension() != ".yaml") continue;
    const auto profile = load_profile(file.path());
    EXPECT_TRUE(profile) << to_string(profile.error());
    ++profiles;
  }
  EXPECT_GT(profiles, 0);
}

TEST(RobotProfile, OneThatIsNotThereIsAWrongArgument) {
  const auto profile = load_profile("/nowhere/robot.yaml");
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().code, Errc::kInvalidConfig);
  EXPECT_EQ(profile.error().where, "/nowhere/robot.yaml");
}

TEST(RobotProfile, OneThatCannotBeReadIsAWrongArgument) {
  const support::TemporaryFolder folder;
  const auto a_folder = load_profile(folder.path());
  ASSERT_FALSE(a_folder);
  EXPECT_EQ(a_folder.error().code, Errc::kInvalidConfig);
  std::ofstream(folder / "large.yaml") << std::string(2'000'000, '#');
  const auto large = load_profile(folder / "large.yaml");
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Errc::kInvalidConfig);
  EXPECT_EQ(large.error().cause, "the file is too large");
}

TEST(RobotProfile, AMountInDegreesIsRefused) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "robot.yaml") << "lidar: {T_base_lidar: [0.1, 0, 0.5, 0, 0, 90]}\n"
                                       << "camera: {T_base_camera: [90, 0, 0, 0, -90, 0]}\n";
  const auto profile = load_profile(folder / "robot.yaml");
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().code, Errc::kInvalidConfig);
  EXPECT_NE(profile.error().detail.find("lidar.T_base_lidar: roll, pitch and yaw are in radians"), std::string::npos);
  EXPECT_NE(profile.error().detail.find("camera.T_base_camera"), std::string::npos);
}

TEST(RobotProfile, TheWrittenProfileReadsBackAsItself) {
  RobotProfile profile;
  profile.name = "x";
  profile.lidar.base_xyz_rpy = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  profile.mapping.resolution_m = 0.2;
  const std::string yaml = to_yaml(profile);
  RobotProfile again;
  config::Section section;
  declare(section, again);
  ASSERT_TRUE(config::parse(yaml, "written", section)) << yaml;
  EXPECT_EQ(to_yaml(again), yaml);
  EXPECT_NEAR((again.robot().T_base_lidar.translation() - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 0, 1e-15);
}

Result<RobotProfile> loaded(const std::string& yaml) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "robot.yaml") << yaml;
  return load_profile(folder / "robot.yaml");
}

TEST(RobotProfile, ATaskThatStopsTheRobotIsReleasedFiftyTimesASecondAtLeast) {
  EXPECT_TRUE(loaded("schedule: {safety: {rate_hz: 50}, drive: {rate_hz: 50}}"));
  for (const std::string task : {"safety", "drive"}) {
    const auto slow = loaded("schedule: {" + task + ": {rate_hz: 49}}");
    ASSERT_FALSE(slow) << task;
    EXPECT_EQ(slow.error().code, Errc::kInvalidConfig);
    EXPECT_NE(slow.error().detail.find("schedule." + task + ".rate_hz is below 50 Hz: this task stops the robot"),
              std::string::npos)
        << to_string(slow.error());
  }
}

TEST(RobotProfile, ADeploymentIsAPoseWithItsUncertainty) {
  EXPECT_FALSE(loaded("team: {id: 1}")->team.deployment.T_site_odom());
  const auto profile = loaded("team: {id: 1, deployment: {x_m: 3, yaw_deg: 90, sigma_m: 0.5, sigma_deg: 10}}");
  ASSERT_TRUE(profile) << to_string(profile.error());
  const auto T_site_odom = profile->team.deployment.T_site_odom();
  ASSERT_TRUE(T_site_odom);
  EXPECT_NEAR((T_site_odom->mean * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(3, 1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(T_site_odom->covariance(0, 0), 0.25, 1e-12);
  EXPECT_NEAR(std::sqrt(T_site_odom->covariance(5, 5)), 0.1745, 1e-4);
  EXPECT_LT(T_site_odom->covariance(3, 3), T_site_odom->covariance(5, 5));
}

TEST(RobotProfile, ADeploymentThatSaysTooLittleIsRefused) {
  for (const char* yaml :
       {"team: {id: 1, deployment: {x_m: 3}}", "team: {deployment: {x_m: 3, sigma_m: 1}}",
        "team: {id: 1, deployment: {sigma_m: 0.0001}}", "team: {id: 1, deployment: {sigma_m: -1}}"}) {
    const auto profile = loaded(yaml);
    ASSERT_FALSE(profile) << yaml;
    EXPECT_EQ(profile.error().code, Errc::kInvalidConfig);
    EXPECT_NE(to_string(profile.error()).find("robot.yaml"), std::string::npos);
    EXPECT_NE(to_string(profile.error()).find("deployment"), std::string::npos) << to_string(profile.error());
  }
}

TEST(RobotProfile, SatellitesReplaceADeployment) {
  const auto profile = loaded("team: {id: 1, satellites: {origin_latitude_deg: 51.9, origin_longitude_deg: 4.4}}");
  ASSERT_TRUE(profile) << to_string(profile.error());
  EXPECT_TRUE(profile->team.satellites.on());
  for (const char* yaml : {"team: {id: 1, deployment: {x_m: 3, sigma_m: 1}, satellites: {origin_latitude_deg: 51.9}}",
                           "team: {satellites: {origin_latitude_deg: 51.9}}"}) {
    const auto wrong = loaded(yaml);
    ASSERT_FALSE(wrong) << yaml;
    EXPECT_NE(to_string(wrong.error()).find("satellites"), std::string::npos) << to_string(wrong.error());
  }
}

TEST(RobotProfile, ATriggeredCameraNeedsATriggerLine) {
  const auto wrong = loaded("camera: {capture: {device: /dev/video0, triggered: true}}");
  ASSERT_FALSE(wrong);
  EXPECT_NE(to_string(wrong.error()).find("gpio.trigger_line"), std::string::npos) << to_string(wrong.error());
  EXPECT_TRUE(loaded("camera: {capture: {device: /dev/video0, triggered: true}}\ngpio: {trigger_line: out}"));
}

TEST(RobotProfile, AMapThatNothingWouldEnterIsRefused) {
  const auto wrong = loaded("lidar: {maps: false}");
  ASSERT_FALSE(wrong);
  EXPECT_NE(to_string(wrong.error()).find("depth.map.rate_hz"), std::string::npos) << to_string(wrong.error());
  const auto right = loaded("lidar: {maps: false}\ndepth: {map: {rate_hz: 5}}");
  ASSERT_TRUE(right) << to_string(right.error());
  EXPECT_FALSE(right->robot().lidar_maps);
  EXPECT_TRUE(loaded("threads: 1")->robot().lidar_maps);
}

constexpr const char* kCameraInfo =
    "image_width: 672\nimage_height: 376\ncamera_matrix: {rows: 3, cols: 3, data: [350, 0, 335.5, 0, 351, 187.5, 0, 0, "
    "1]}\ndistortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [-0.17, 0.026, 0, 0, 0]}\n";

TEST(RobotProfile, ACalibrationFileBesideTheProfileBecomesItsIntrinsics) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "left.yaml") << kCameraInfo;
  std::ofstream(folder / "robot.yaml") << "camera: {intrinsics: {calibration: left.yaml, baseline_m: 0.12}}\n";
  const auto profile = load_profile(folder / "robot.yaml");
  ASSERT_TRUE(profile) << to_string(profile.error());
  EXPECT_EQ(profile->camera.intrinsics.fy, 351);
  EXPECT_EQ(profile->camera.intrinsics.k1, -0.17);
  EXPECT_EQ(profile->camera.intrinsics.baseline_m, 0.12);
  EXPECT_FALSE(profile->thermal.intrinsics.calibrated());
  std::ofstream(folder / "config.yaml") << to_yaml(*profile);
  std::filesystem::remove(folder / "left.yaml");
  const auto again = load_profile(folder / "config.yaml");
  ASSERT_TRUE(again) << "what a run keeps needs no other file";
  EXPECT_EQ(to_yaml(*again), to_yaml(*profile));
}

TEST(RobotProfile, IntrinsicsThatDoNotFitAreRefusedWithTheirKeys) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "left.yaml") << kCameraInfo;
  std::ofstream(folder / "robot.yaml")
      << "camera: {capture: {width: 1280, height: 480}, intrinsics: {calibration: left.yaml}}\n"
      << "thermal: {intrinsics: {fx: 200, fy: 200, cx: 79.5, cy: 130}}\n";
  const auto profile = load_profile(folder / "robot.yaml");
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().code, Errc::kInvalidConfig);
  const std::string text = to_string(profile.error());
  EXPECT_NE(text.find("camera.intrinsics.width, height: the calibration is of 672x376 pixels, a picture of 640x480"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("thermal.intrinsics.cy: the principal point must lie in the picture"), std::string::npos)
      << "without the two rows of telemetry the picture has 120\n"
      << text;
}

TEST(RobotProfile, ACalibrationThatIsMissingIsAWrongArgument) {
  const auto profile = loaded("camera: {intrinsics: {calibration: nowhere.yaml}}");
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().code, Errc::kInvalidConfig);
  EXPECT_NE(to_string(profile.error()).find("camera.intrinsics.calibration"), std::string::npos);
  EXPECT_NE(to_string(profile.error()).find("nowhere.yaml"), std::string::npos);
}

TEST(RobotProfile, WithoutAFileTheDefaultsHold) {
  const auto profile = load_profile({});
  ASSERT_TRUE(profile);
  EXPECT_EQ(to_yaml(*profile), to_yaml(RobotProfile{}));
}

}  // namespace
}  // namespace cairn::app
