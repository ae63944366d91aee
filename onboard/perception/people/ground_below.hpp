// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace cairn::people {

/// How high a sensor that flies is above the ground, from what it sees: m. None: too little of it is in view. The
/// ground is the lowest level of odom (z is up, m) at which many points lie; a few wrong points may be below it.
[[nodiscard]] std::optional<float> height_above_ground(std::span<const Eigen::Vector3f> points_odom,
                                                       const Eigen::Vector3f& sensor_odom);

}  // namespace cairn::people
