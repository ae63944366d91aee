// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion/peers/items/item.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::peers {

/// Where a submap lies in its robot's odom frame. The covariance is that of the motion since the submap before.
struct Submap {
  UncertainPose T_odom_submap;
};

/// What one robot has found out about another: where the other's submap lies in its own.
struct Edge {
  std::uint16_t own_submap = 0;
  RobotId other = 0;
  Epoch other_epoch = 0;
  std::uint16_t other_submap = 0;
  UncertainPose T_own_other;
  float probability = 0;  ///< that it is right, 0…1
};

/// Where the robot's odom frame lies by something else than maps: a survey, a marked place, a GPS fix, or a person. It
/// may be wrong.
struct Deployment {
  UncertainPose T_ref_odom;
  RobotId ref = 0;      ///< in whose odom frame it lies; 0: in a metric frame, z up, that the whole team shares
  Epoch ref_epoch = 0;  ///< of that robot's beginning; 0 without one
  /// Above 0, maps do not overrule it: a person or satellites say so. Counts up with each word that makes what was
  /// found before void. 0: it is only a guess, as of the profile.
  std::uint32_t firm = 0;
};

/// Payloads of items. Poses as seven doubles (translation, quaternion x y z w with w ≥ 0), covariances as the 21 floats
/// of their upper triangle, row by row.
[[nodiscard]] std::vector<std::byte> encode(const Submap& submap);
[[nodiscard]] std::vector<std::byte> encode(const Edge& edge);
[[nodiscard]] std::vector<std::byte> encode(const Deployment& deployment);

/// Decode exactly what encode() can have written. Positions are within 10⁶ m, quaternions have length 1, covariances
/// are finite with a positive diagonal, and a deployment's is positive definite. Errors: kTruncated, kMalformed.
[[nodiscard]] Result<Submap> decode_submap(std::span<const std::byte> bytes);
[[nodiscard]] Result<Edge> decode_edge(std::span<const std::byte> bytes);
[[nodiscard]] Result<Deployment> decode_deployment(std::span<const std::byte> bytes);

}  // namespace cairn::peers
