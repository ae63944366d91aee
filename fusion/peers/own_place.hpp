// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/peers/datagrams/datagram.hpp"
#include "hal/se3.hpp"

namespace cairn::peers {

/// A robot's pose in its odom frame, as a hello tells it. Standard deviations above 10⁶ m or rad become
/// 10⁶. Nothing for a position that is not finite or beyond 10⁶ m: peers would refuse the datagram.
[[nodiscard]] std::optional<Hello::Place> place_of(const UncertainPose& T_odom_base);

}  // namespace cairn::peers
