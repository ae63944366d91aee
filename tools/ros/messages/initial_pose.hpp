// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "drivers/clients/messages/command.hpp"
#include "tools/ros/messages/types.hpp"

namespace cairn::ros {

/// What is assumed where the covariance says nothing: what rviz writes.
inline constexpr double kGuessedSigma_m = 0.5, kGuessedSigma_rad = 0.26;

/// Where somebody says that the robot is, as in rviz "2D Pose Estimate". Frames: "team"; "NAME/odom" or "NAME" of a
/// teammate; "map" and "site" are the frame of start poses. Only x, y and yaw count. On failure, `why` says it.
[[nodiscard]] std::optional<clients::Placement> placement_from(const PoseWithCovarianceStamped& pose,
                                                               std::string_view& why);

}  // namespace cairn::ros
