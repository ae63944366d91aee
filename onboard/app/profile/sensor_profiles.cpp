// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/sensor_profiles.hpp"

#include "drivers/thermal/models.hpp"

namespace cairn::app {
namespace {

void declare_mount(config::Section& s, std::vector<double>& mount, const char* key, const char* whose) {
  s.numbers(key, mount, {-100, 100}, "m, rad",
            std::string("pose of the ") + whose + " in base_link: x, y, z, roll, pitch, yaw (fixed axes)");
}

void declare_trust(config::Section& s, mapping::SensorTrust& trust) {
  s.number("prob_hit", trust.prob_hit, {0.51, 0.99}, "", "probability that a hit voxel is occupied");
  s.number("prob_miss", trust.prob_miss, {0.01, 0.49}, "", "probability that a voxel seen through is occupied");
  s.number("max_range_m", trust.max_range_m, {0.1, 100}, "m",
           "farther points mark nothing occupied; only the space before them is marked free, up to here");
}

}  // namespace

void declare(config::Section& s, LidarProfile& p) {
  s.flag("enabled", p.enabled, "whether the robot carries one");
  s.flag("maps", p.maps, "whether its points enter the map; false: it tells the motion, and depth.map makes the map");
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_lidar", "LiDAR");
}

void declare(config::Section& s, CameraProfile& p) {
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_camera", "camera (x along its view, y left, z up)");
  s.group("intrinsics", p.intrinsics, "how the (left) eye sees");
}

void declare(config::Section& s, ThermalProfile& p) {
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_thermal", "thermal camera (x along its view, y left, z up)");
  s.group("intrinsics", p.intrinsics, "how it sees");
}

void declare(config::Section& s, DepthProfile& p) {
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_depth", "depth camera (x along its view, y left, z up)");
  s.group("map", p.map, "how its clouds get into the map, beside the LiDAR's or alone");
}

void declare(config::Section& s, DepthMapProfile& p) {
  s.number("rate_hz", p.rate_hz, {0, 30}, "Hz", "clouds per second, at most; 0: the map gets none");
  declare_trust(s, p.trust);
}

void declare(config::Section& s, StereoProfile& p) {
  s.choice("odometry", p.odometry, {"auto", "never"},
           "auto: both eyes tell the motion of a robot without a LiDAR, and its map is made of what they see");
  s.number("map_rate_hz", p.map_rate_hz, {0.1, 30}, "Hz", "clouds per second that get into the map, at most");
  declare_trust(s, p.trust);
  s.group("dense", p.dense, "how the points that both eyes see are found");
}

void declare(config::Section& s, DriveProfile& p) { declare(s, p.driver); }
void declare(config::Section& s, GpioProfile& p) { declare(s, p.driver); }

PictureSize picture_size(const CameraProfile& p) {
  const camera::CaptureConfig& capture = p.driver.capture;
  return {p.driver.side_by_side ? capture.width / 2 : capture.width, capture.height};
}

PictureSize picture_size(const ThermalProfile& p) {
  const camera::CaptureConfig& capture = p.driver.capture;
  const thermal::Model* model = thermal::find_model(p.driver.model);
  const bool telemetry =
      model != nullptr && model->rows > 0 && static_cast<std::uint32_t>(capture.height) == model->height + model->rows;
  return {capture.width, telemetry ? static_cast<int>(model->height) : capture.height};
}

}  // namespace cairn::app
