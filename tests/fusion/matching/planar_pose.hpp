// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"

namespace cairn::matching {

/// A pose in the plane: x and y in m, heading in rad.
inline SE3 planar_pose(double x_m, double y_m, double yaw_rad) {
  return SE3::from_xyz_rpy((Vector6() << x_m, y_m, 0, 0, 0, yaw_rad).finished());
}

}  // namespace cairn::matching
