// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::app {

/// Where the robot was when a scan ended. From odometry to who needs poses alone.
struct ArrivedPose {
  Time stamp{};
  SE3 T_odom_base;
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s
  std::uint32_t epoch = 0;          ///< see TrackPoint
};

}  // namespace cairn::app
