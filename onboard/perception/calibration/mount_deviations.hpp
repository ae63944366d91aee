// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/se3.hpp"

namespace cairn::calibration {

/// Limits of standard deviations. Beyond them a calibration is refused.
struct MountLimits {
  double place_m = 0.02;  ///< along each axis
  double turn_deg = 0.3;  ///< about each axis
};

/// Standard deviations of x y z roll pitch yaw of T_points_camera, metres and radians. `sigma`: covariance of the right
/// perturbation of T_optical_points, where T_points_camera = T_optical_points⁻¹ · T_optical_camera. Infinite where
/// `sigma` is.
[[nodiscard]] Vector6 mount_deviations(const SE3& T_points_camera, const Matrix6& sigma);
/// What `limits` say against them, one sentence each.
[[nodiscard]] std::vector<std::string> mount_faults(const Vector6& deviations, const MountLimits& limits);

}  // namespace cairn::calibration
