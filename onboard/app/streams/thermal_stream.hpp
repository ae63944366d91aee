// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/clients/messages/clouds/thermal.hpp"
#include "drivers/thermal/thermal.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/streams/cloud_stream.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"
#include "onboard/perception/labelling/thermal_joiner.hpp"

namespace cairn::app {

/// For CloudStream: thermal clouds.
struct ThermalKind {
  using Cloud = labelling::ThermalCloud;
  static clients::ThermalPart part_of(const Cloud& cloud) {
    return {.stamp = cloud.stamp, .celsius = cloud.celsius, .epoch = cloud.epoch, .T_odom_base = cloud.T_odom_base};
  }
  static std::span<const ThermalPoint> points_of(const Cloud& cloud) { return cloud.points; }
  static std::optional<std::uint32_t>& sent(StreamClient& client) { return client.thermal_points; }
  static bool due(StreamClient& client, const Cloud& cloud) {
    return client.wants.wants(clients::Stream::kThermal) && client.thermals.due(cloud.stamp);
  }
};

/// Makes thermal clouds for clients. To be given scans and pictures only while a client wants them.
class ThermalStream {
 public:
  /// `monitor` must outlive the stream.
  ThermalStream(thermal::Thermal camera, labelling::ThermalLifter lifter, Monitor& monitor);

  /// A scan later than all before. One whose pose is lost is left out.
  void add(const LocatedScan& scan);
  /// A picture as the camera sent it. Those of a flat-field correction are left out.
  void add(const Packet& picture);
  /// Sends what clients take now, in at most `records` records for all of them.
  void serve(ClientHub& hub, std::size_t records);

 private:
  thermal::Thermal camera_;
  labelling::ThermalJoiner joiner_;
  Monitor& monitor_;
  SpscQueue<labelling::ThermalCloud> clouds_{4};
  CloudStream<ThermalKind> stream_;
};

}  // namespace cairn::app
