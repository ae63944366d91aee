// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

namespace cairn::people {

/// Whether rays of the scan go through a body's place: enough of them, and several times as many as end there. What a
/// scan merely does not show, because something stands before it, is not seen through. Points and sensor in odom, m.
[[nodiscard]] bool seen_through(const Eigen::Vector2d& position, float ground,
                                std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom);

}  // namespace cairn::people
