// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/sensor_profiles.hpp"

namespace cairn::app {
namespace {

void declare_mount(config::Section& s, std::vector<double>& mount, const char* key, const char* whose) {
  s.numbers(key, mount, {-100, 100}, "m, rad",
            std::string("pose of the ") + whose + " in base_link: x, y, z, roll, pitch, yaw (fixed axes)");
}

}  // namespace

void declare(config::Section& s, LidarProfile& p) {
  s.flag("enabled", p.enabled, "whether the robot carries one");
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_lidar", "LiDAR");
}

void declare(config::Section& s, CameraProfile& p) {
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_camera", "camera (x along its view, y left, z up)");
}

void declare(config::Section& s, ThermalProfile& p) {
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_thermal", "thermal camera (x along its view, y left, z up)");
}

void declare(config::Section& s, DepthProfile& p) {
  declare(s, p.driver);
  declare_mount(s, p.base_xyz_rpy, "T_base_depth", "depth camera (x along its view, y left, z up)");
}

void declare(config::Section& s, DriveProfile& p) { declare(s, p.driver); }
void declare(config::Section& s, GpioProfile& p) { declare(s, p.driver); }

}  // namespace cairn::app
