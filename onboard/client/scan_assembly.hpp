// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/clients/messages/scan.hpp"

namespace cairn::client {

/// A whole scan that has been located.
struct ScanMessage {
  Time stamp{};                              ///< of the scan's end
  bool lost = false;                         ///< the pose is only a prediction
  std::uint32_t epoch = 0;                   ///< see clients::PoseMessage
  SE3 T_odom_base;                           ///< at `stamp`
  std::vector<Eigen::Vector3f> points_base;  ///< deskewed, in base_link at `stamp`, in metres
};

/// Makes scans of their parts. A scan of which a part is missing is left out. Memory is bounded by
/// clients::ScanPart::kMaxPoints.
class ScanAssembly {
 public:
  /// The scan that this part completes, if it does.
  [[nodiscard]] std::optional<ScanMessage> take(clients::ScanPart part);

 private:
  std::optional<ScanMessage> scan_;
};

}  // namespace cairn::client
