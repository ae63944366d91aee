// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/robot_profile.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace cairn {
namespace {

TEST(RobotProfile, EveryProfileInConfigIsValid) {
  int profiles = 0;
  for (const auto& file : std::filesystem::directory_iterator(CAIRN_SOURCE_DIR "/config")) {
    if (file.path().extension() != ".yaml") continue;
    const auto profile = load_profile(file.path());
    EXPECT_TRUE(profile) << to_string(profile.error());
    ++profiles;
  }
  EXPECT_GT(profiles, 0);
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

TEST(RobotProfile, WithoutAFileTheDefaultsHold) {
  const auto profile = load_profile({});
  ASSERT_TRUE(profile);
  EXPECT_EQ(to_yaml(*profile), to_yaml(RobotProfile{}));
}

}  // namespace
}  // namespace cairn
