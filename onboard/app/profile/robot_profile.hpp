// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "hal/config/config.hpp"
#include "hal/result.hpp"
#include "onboard/app/profile/perception_profile.hpp"
#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/app/profile/sensor_profiles.hpp"
#include "onboard/app/profile/team_profile.hpp"
#include "onboard/app/restart/restart.hpp"
#include "onboard/robot.hpp"
#include "onboard/safety/failsafe_config.hpp"
#include "onboard/safety/overload.hpp"

namespace cairn::app {

/// Everything that is said about one robot: config/husky.yaml and its like.
struct RobotProfile {
  std::string name = "robot";
  LidarProfile lidar;
  CameraProfile camera;
  ThermalProfile thermal;
  DepthProfile depth;
  StereoProfile stereo;
  DriveProfile drive;
  GpioProfile gpio;
  odometry::OdometryConfig odometry;
  visual_odometry::VisualOdometryConfig visual_odometry;
  mapping::MappingConfig mapping;
  PerceptionProfile perception;
  safety::FailsafeConfig failsafe;
  safety::OverloadConfig overload;
  RestartProfile restart;
  TeamProfile team;
  double odometry_deadline_s = 0.08;  ///< live: no further refinement of a pose this long after its last packet
  int threads = 1;
  ScheduleProfile schedule;

  [[nodiscard]] RobotConfig robot() const;
  /// Whether both eyes of the camera tell this robot's motion: it has no LiDAR, and the profile does not forbid it.
  [[nodiscard]] bool sees_its_way() const { return !lidar.enabled && stereo.odometry == "auto"; }
};

void declare(config::Section& section, RobotProfile& profile);

/// `defaults` where `path` is empty; otherwise the file over them, with every fault reported at once. Calibration files
/// that it names are read, and their values are in the profile.
Result<RobotProfile> load_profile(const std::filesystem::path& path, RobotProfile defaults);
/// The same over the program's own defaults.
Result<RobotProfile> load_profile(const std::filesystem::path& path);
/// The effective values as YAML, as they are kept with every run.
[[nodiscard]] std::string to_yaml(RobotProfile profile);

}  // namespace cairn::app
