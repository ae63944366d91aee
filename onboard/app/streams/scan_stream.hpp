// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "drivers/clients/messages/clouds/scan.hpp"
#include "onboard/app/streams/cloud_stream.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"

namespace cairn::app {

/// For CloudStream: located scans.
struct ScanKind {
  using Cloud = LocatedScan;
  static clients::ScanPart part_of(const LocatedScan& scan) {
    return {.stamp = scan.stamp, .lost = scan.lost, .epoch = scan.epoch, .T_odom_base = scan.T_odom_base.mean};
  }
  static std::span<const Eigen::Vector3f> points_of(const LocatedScan& scan) { return scan.points_base; }
  static std::optional<std::uint32_t>& sent(StreamClient& client) { return client.scan_points; }
  static bool due(StreamClient& client, const LocatedScan& scan) {
    return client.wants.wants(clients::Stream::kScan) && client.scans.due(scan.stamp);
  }
};

using ScanStream = CloudStream<ScanKind>;

}  // namespace cairn::app
