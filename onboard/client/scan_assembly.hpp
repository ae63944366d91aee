// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "drivers/clients/messages/clouds/scan.hpp"
#include "drivers/clients/messages/clouds/thermal.hpp"
#include "onboard/client/cloud_assembly.hpp"

namespace cairn::client {

/// A whole scan that has been located.
struct ScanMessage {
  Time stamp{};                                ///< of the scan's end
  bool lost = false;                           ///< the pose is only a prediction
  std::uint32_t epoch = 0;                     ///< see clients::PoseMessage
  SE3 T_odom_base{};                           ///< at `stamp`
  std::vector<Eigen::Vector3f> points_base{};  ///< deskewed, in base_link at `stamp`, in metres

  /// Without points, as one of its parts tells it.
  static ScanMessage begin(const clients::ScanPart& part) {
    return {.stamp = part.stamp, .lost = part.lost, .epoch = part.epoch, .T_odom_base = part.T_odom_base};
  }
};

/// A whole thermal cloud: the points of a scan that the thermal camera sees, and what it measures there.
struct ThermalMessage {
  Time stamp{};                        ///< when the picture was taken
  bool celsius = false;                ///< false: values are raw counts
  std::uint32_t epoch = 0;             ///< see clients::PoseMessage
  SE3 T_odom_base{};                   ///< at `stamp`
  std::vector<ThermalPoint> points{};  ///< in base_link at `stamp`

  /// Without points, as one of its parts tells it.
  static ThermalMessage begin(const clients::ThermalPart& part) {
    return {.stamp = part.stamp, .celsius = part.celsius, .epoch = part.epoch, .T_odom_base = part.T_odom_base};
  }
};

using ScanAssembly =
    CloudAssembly<clients::ScanPart, ScanMessage, &clients::ScanPart::points_base, &ScanMessage::points_base>;
using ThermalAssembly =
    CloudAssembly<clients::ThermalPart, ThermalMessage, &clients::ThermalPart::points, &ThermalMessage::points>;

}  // namespace cairn::client
