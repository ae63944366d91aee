// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/robot_profile.hpp"

#include <Eigen/Core>

namespace cairn::app {

RobotConfig RobotProfile::robot() const {
  return {SE3::from_xyz_rpy(Eigen::Map<const Vector6>(lidar.base_xyz_rpy.data())), odometry, mapping};
}

void declare(config::Section& s, RobotProfile& p) {
  s.text("name", p.name, "the robot's name in files and to its peers");
  s.integer("threads", p.threads, {1, 64}, "", "threads for odometry and mapping; the result does not depend on it");
  s.group("lidar", p.lidar, "the LiDAR and its mount");
  s.group("camera", p.camera,
          "the colour camera, single or stereo; it exists when capture.device is named; it is watched and recorded, by "
          "cairn record and cairn run --record");
  s.group("thermal", p.thermal, "the thermal camera; likewise");
  s.group("depth", p.depth, "the depth camera; likewise");
  s.group("drive", p.drive, "the drive on its CAN bus; it exists when interface is named");
  s.group("gpio", p.gpio, "e-stop, camera trigger and PPS; they exist when their lines are named");
  s.group("odometry", p.odometry, "scan-to-map registration");
  s.number("odometry_deadline_s", p.odometry_deadline_s, {0.001, 10}, "s",
           "live: no further refinement of a pose this long after its last packet");
  s.group("mapping", p.mapping, "the OctoMap");
  s.group("schedule", p.schedule, "the fixed-rate tasks and what they may cost");
  s.group(
      "failsafe", p.failsafe,
      "what each fault leads to (normal, degraded, hold, stop), and after how long a source counts as missing; both "
      "may be stricter than the defaults, never milder");
  s.group("overload", p.overload, "when work is left undone, and when it is taken up again");
  s.group("restart", p.restart, "what a core that starts again goes on from");
  s.group("team", p.team, "the robot's place in a team; cairn run --peers takes part in it");
}

Result<RobotProfile> load_profile(const std::filesystem::path& path, RobotProfile profile) {
  if (path.empty()) return profile;
  config::Section section;
  declare(section, profile);
  if (const auto loaded = config::load(path, section); !loaded) return loaded.error();
  if (auto sound = check(profile.failsafe); !sound) return at(path.string(), sound.error());
  if (auto sound = check(profile.team); !sound) return at(path.string(), sound.error());
  return profile;
}

std::string to_yaml(RobotProfile profile) {
  config::Section section;
  declare(section, profile);
  return config::to_yaml(section);
}

}  // namespace cairn::app
