// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace cairn {

/// A point that a thermal camera sees, and what it measures there.
struct ThermalPoint {
  Eigen::Vector3f point_base = Eigen::Vector3f::Zero();  ///< in base_link, m
  float value = 0;  ///< °C, or raw counts where the camera does not tell their unit
};

}  // namespace cairn
