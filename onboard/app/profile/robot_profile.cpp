// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/robot_profile.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace cairn::app {

RobotConfig RobotProfile::robot() const {
  RobotConfig config;
  config.T_base_lidar = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(lidar.base_xyz_rpy.data()));
  config.odometry = odometry;
  config.mapping = mapping;
  config.lidar_maps = lidar.maps;
  if (depth.map.rate_hz > 0) config.depth = depth.map.trust;
  return config;
}

void declare(config::Section& s, RobotProfile& p) {
  s.text("name", p.name, "the robot's name in files and to its peers");
  s.integer("threads", p.threads, {1, 64}, "", "threads for odometry and mapping; the result does not depend on it");
  s.group("lidar", p.lidar, "the LiDAR and its mount");
  s.group("camera", p.camera,
          "the colour camera, single or stereo; it exists when capture.device is named; a live run opens it for "
          "networks, where both eyes tell the motion, for clients (--sockets), and to record it (--record)");
  s.group("thermal", p.thermal,
          "the thermal camera; a live run opens it for perception.thermal_detection, for clients, and to record it");
  s.group("depth", p.depth, "the depth camera; a live run opens it for depth.map, for clients, and to record it");
  s.group("stereo", p.stereo, "what both eyes of the colour camera are used for");
  s.group("drive", p.drive, "the drive on its CAN bus; it exists when interface is named");
  s.group("gpio", p.gpio, "e-stop, camera trigger and PPS; they exist when their lines are named");
  s.group("odometry", p.odometry, "scan-to-map registration");
  s.group("visual_odometry", p.visual_odometry, "the motion of a robot without a LiDAR, by both eyes of its camera");
  s.number("odometry_deadline_s", p.odometry_deadline_s, {0.001, 10}, "s",
           "live: no further refinement of a pose this long after its last packet");
  s.group("mapping", p.mapping, "the OctoMap");
  s.group("perception", p.perception, "networks that look at pictures, and how the map takes their labels");
  s.group("schedule", p.schedule, "the fixed-rate tasks and what they may cost");
  s.group(
      "failsafe", p.failsafe,
      "what each fault leads to (normal, degraded, hold, stop), and after how long a source counts as missing; both "
      "may be stricter than the defaults, never milder");
  s.group("overload", p.overload, "when work is left undone, and when it is taken up again");
  s.group("restart", p.restart, "what a core that starts again goes on from");
  s.group("team", p.team, "the robot's place in a team; cairn run --peers takes part in it");
}

namespace {

/// A wrong argument, as everything else that is wrong with a profile: also one that cannot be read.
Error unusable(Error error, const std::filesystem::path& path) {
  if (error.code == Errc::kNotFound)
    return {Errc::kInvalidConfig, "there is no such profile", path.string(), {}, "without one, the defaults hold"};
  error.code = Errc::kInvalidConfig;
  return error;
}

/// Angles beyond a full turn were meant in degrees.
Result<void> check_mounts(const RobotProfile& p) {
  const std::pair<const char*, const std::vector<double>*> mounts[] = {
      {"lidar.T_base_lidar", &p.lidar.base_xyz_rpy},
      {"camera.T_base_camera", &p.camera.base_xyz_rpy},
      {"thermal.T_base_thermal", &p.thermal.base_xyz_rpy},
      {"depth.T_base_depth", &p.depth.base_xyz_rpy}};
  std::string faults;
  for (const auto& [key, mount] : mounts)
    if (std::any_of(mount->begin() + 3, mount->end(), [](double rad) { return std::abs(rad) > 2 * std::numbers::pi; }))
      faults +=
          std::string("\n") + key + ": roll, pitch and yaw are in radians, up to a full turn; 90 degrees are 1.5708";
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the profile", {}, {}, faults};
}

/// Each line of `faults` below its key.
std::string below(const std::string& key, const std::string& faults) {
  std::string lines;
  for (std::size_t start = 0; start <= faults.size();) {
    const std::size_t end = std::min(faults.find('\n', start), faults.size());
    if (end > start) lines += "\n" + key + "." + faults.substr(start, end - start);
    start = end + 1;
  }
  return lines;
}

/// Takes the values of the file that `intrinsics` names, if it does, and checks them with the picture's size. Returns
/// the faults, one line each.
template <class Profile>
std::string calibrate(Profile& camera, const std::string& key, const std::filesystem::path& folder) {
  const auto T_base_camera = cameras::take_calibration(camera.intrinsics, folder);
  if (!T_base_camera) return "\n" + key + ".calibration: " + to_string(T_base_camera.error());
  if (*T_base_camera) {
    const Vector6 mount = (*T_base_camera)->xyz_rpy();
    if (mount.cwiseAbs().maxCoeff() > 100) return "\n" + key + ".calibration: T_BS is more than 100 m away";
    camera.base_xyz_rpy.assign(mount.begin(), mount.end());
  }
  const PictureSize size = picture_size(camera);
  const auto sound = check(camera.intrinsics, size.width, size.height);
  return sound ? "" : below(key, sound.error().detail);
}

Result<void> calibrate_cameras(RobotProfile& p, const std::filesystem::path& folder) {
  const std::string faults =
      calibrate(p.camera, "camera.intrinsics", folder) + calibrate(p.thermal, "thermal.intrinsics", folder);
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the profile", {}, {}, faults};
}

/// A camera that waits for pulses which nobody sends gives no picture.
Result<void> check_trigger(const RobotProfile& p) {
  if (!p.gpio.driver.trigger_line.empty()) return {};
  std::string faults;
  const auto name = [&](const char* section, bool triggered) {
    if (triggered) faults += std::string("\n") + section + ".capture.triggered is set, but gpio.trigger_line is not";
  };
  name("camera", p.camera.driver.capture.triggered);
  name("thermal", p.thermal.driver.capture.triggered);
  name("depth", p.depth.driver.capture.triggered);
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the profile", {}, {}, faults.substr(1)};
}

/// A robot that drives and maps nothing looks as if all were well.
Result<void> check_map(const RobotProfile& p) {
  if (!p.lidar.enabled || p.lidar.maps || p.depth.map.rate_hz > 0) return {};
  return Error{Errc::kInvalidConfig,
               "nothing would enter the map: lidar.maps is false, and depth.map.rate_hz is 0",
               {},
               {},
               "set depth.map.rate_hz, such as 5, or leave lidar.maps out"};
}

}  // namespace

Result<RobotProfile> load_profile(const std::filesystem::path& path, RobotProfile profile) {
  if (path.empty()) return profile;
  config::Section section;
  declare(section, profile);
  if (const auto loaded = config::load(path, section); !loaded) return unusable(loaded.error(), path);
  if (auto sound = check(profile.failsafe); !sound) return at(path.string(), sound.error());
  if (auto sound = check(profile.schedule); !sound) return at(path.string(), sound.error());
  if (auto sound = check(profile.perception); !sound) return at(path.string(), sound.error());
  if (auto sound = check(profile.team); !sound) return at(path.string(), sound.error());
  if (auto sound = check_trigger(profile); !sound) return at(path.string(), sound.error());
  if (auto sound = check_map(profile); !sound) return at(path.string(), sound.error());
  if (auto sound = check_mounts(profile); !sound) return at(path.string(), sound.error());
  if (auto sound = calibrate_cameras(profile, path.parent_path()); !sound) return at(path.string(), sound.error());
  return profile;
}

Result<RobotProfile> load_profile(const std::filesystem::path& path) { return load_profile(path, RobotProfile()); }

std::string to_yaml(RobotProfile profile) {
  config::Section section;
  declare(section, profile);
  return config::to_yaml(section);
}

}  // namespace cairn::app
