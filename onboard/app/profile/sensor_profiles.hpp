// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "drivers/camera/config.hpp"
#include "drivers/depth/config.hpp"
#include "drivers/drive/chassis/config.hpp"
#include "drivers/gpio/config.hpp"
#include "drivers/thermal/config.hpp"
#include "drivers/velodyne/config.hpp"
#include "hal/config/config.hpp"
#include "onboard/mapping/mapping_config.hpp"
#include "onboard/perception/cameras/camera_intrinsics.hpp"
#include "onboard/perception/stereo/dense_stereo.hpp"

namespace cairn::app {

/// How a LiDAR is mounted and spoken to.
struct LidarProfile {
  bool enabled = true;
  bool maps = true;  ///< whether its points enter the map; it tells the motion in any case
  velodyne::Config driver;
  std::vector<double> base_xyz_rpy{0, 0, 0, 0, 0, 0};  ///< T_base_lidar: x y z [m], roll pitch yaw [rad], fixed axes
};

/// A camera of any kind and its mount. It exists when its device is named.
template <class Driver>
struct MountedCamera {
  Driver driver;
  std::vector<double> base_xyz_rpy{0, 0, 0, 0, 0, 0};  ///< T_base_camera, as T_base_lidar
  [[nodiscard]] bool exists() const { return !driver.capture.device.empty(); }
};
/// The same with a lens that has to be calibrated.
template <class Driver>
struct CalibratedCamera : MountedCamera<Driver> {
  cameras::CameraIntrinsics intrinsics;
};
using CameraProfile = CalibratedCamera<camera::Config>;
using ThermalProfile = CalibratedCamera<thermal::Config>;
/// How the clouds of a depth camera get into the map: section `depth.map`.
struct DepthMapProfile {
  double rate_hz = 0;  ///< clouds per second, at most; 0: the map gets none
  /// An RGB-D camera's noise grows with the square of the distance: 2 % at 3 m are half a voxel of 0.1 m.
  mapping::SensorTrust trust{.prob_hit = 0.6, .prob_miss = 0.45, .max_range_m = 3};
};
/// A depth camera, its mount, and its part in the map.
struct DepthProfile : MountedCamera<depth::Config> {
  DepthMapProfile map;
};

/// What both eyes of the colour camera are used for: section `stereo`.
struct StereoProfile {
  std::string odometry = "auto";  ///< auto: they tell the motion of a robot without a LiDAR; never: they do not
  double map_rate_hz = 5;         ///< clouds per second, at most, of a robot whose motion they tell
  /// The noise of a disparity is the same everywhere, so that of a depth grows with the square of the distance: with
  /// 0.07 pixels, f = 350 pixels and 0.12 m between the eyes, 0.04 m at 5 m and 0.11 m at 8 m.
  mapping::SensorTrust trust{.prob_hit = 0.65, .prob_miss = 0.45, .max_range_m = 8};
  stereo::DenseStereoConfig dense;
};

/// Width and height in pixels of the pictures that are looked at: one eye, without rows of telemetry.
struct PictureSize {
  int width = 0, height = 0;
};
// Doxygen takes these overloads for one function, so they are left out of the API reference.
/// \cond OVERLOADS
[[nodiscard]] PictureSize picture_size(const CameraProfile& profile);
[[nodiscard]] PictureSize picture_size(const ThermalProfile& profile);
/// \endcond

/// The drive on its CAN bus. It exists when its interface is named.
struct DriveProfile {
  DriveProfile() { driver.interface.clear(); }
  drive::Config driver;
  [[nodiscard]] bool exists() const { return !driver.interface.empty(); }
};

/// The GPIO lines. They exist when one of them is named.
struct GpioProfile {
  gpio::Config driver;
  [[nodiscard]] bool exists() const {
    return !driver.estop_line.empty() || !driver.trigger_line.empty() || !driver.pps_line.empty();
  }
};

// Doxygen takes these overloads for one function, so they are left out of the API reference.
/// \cond OVERLOADS
void declare(config::Section& section, LidarProfile& profile);
void declare(config::Section& section, CameraProfile& profile);
void declare(config::Section& section, ThermalProfile& profile);
void declare(config::Section& section, DepthProfile& profile);
void declare(config::Section& section, DepthMapProfile& profile);
void declare(config::Section& section, StereoProfile& profile);
void declare(config::Section& section, DriveProfile& profile);
void declare(config::Section& section, GpioProfile& profile);
/// \endcond

}  // namespace cairn::app
