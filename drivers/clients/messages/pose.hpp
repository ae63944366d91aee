// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/clients/messages/record.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// Where the robot was or, predicted, is.
struct PoseMessage {
  static constexpr RecordKind kKind = RecordKind::kPose;

  Time stamp{};                            ///< robot time: of a scan's end, or of the prediction
  bool predicted = false;                  ///< not of a scan: the last scan's pose, moved on with its twist
  bool lost = false;                       ///< the last scan did not fit: the pose says little
  std::uint8_t degenerate_directions = 0;  ///< 0 … 6: not determined by the last scan
  std::uint32_t epoch = 0;  ///< counts maps; how the poses of two lie to each other is hardly known or not at all
  UncertainPose T_odom_base;
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s
};

/// Appends the body. It is: stamp (8), flags (1; bit 0 predicted, bit 1 lost), degenerate directions (1), zero (2),
/// epoch (4), T_odom_base as x y z qx qy qz qw (7 × 8), the upper triangle of its covariance row by row (21 × 8), twist
/// (6 × 8). Covariance and twist have the order x y z, about x, y, z, in base_link.
void encode(const PoseMessage& message, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<PoseMessage> decode_pose(std::span<const std::byte> body);

}  // namespace cairn::clients
