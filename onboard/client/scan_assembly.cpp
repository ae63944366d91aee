// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/scan_assembly.hpp"

#include <utility>

namespace cairn::client {

std::optional<ScanMessage> ScanAssembly::take(clients::ScanPart part) {
  if (part.first == 0)
    scan_ = ScanMessage{.stamp = part.stamp,
                        .lost = part.lost,
                        .epoch = part.epoch,
                        .T_odom_base = part.T_odom_base,
                        .points_base = {}};
  const bool follows = scan_ && scan_->stamp == part.stamp && scan_->points_base.size() == part.first;
  if (!follows) {
    scan_.reset();
    return std::nullopt;
  }
  scan_->points_base.insert(scan_->points_base.end(), part.points_base.begin(), part.points_base.end());
  if (scan_->points_base.size() < part.total) return std::nullopt;
  return std::exchange(scan_, std::nullopt);
}

}  // namespace cairn::client
