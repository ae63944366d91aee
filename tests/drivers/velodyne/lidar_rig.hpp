// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/velodyne/lidar.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace cairn::velodyne::test {

/// A lidar under test, with its monitor and every scan that came out of it.
struct Rig {
  explicit Rig(const Config& config = {}) : lidar(Lidar::create(config, SourceId{5}, monitor).value()) {}

  /// Decodes; keeps the scan that came out. False when the packet was refused.
  bool give(const Packet& packet) {
    const auto scan = lidar->decode(packet);
    if (scan && *scan != nullptr) scans.push_back(**scan);
    return scan.has_value();
  }
  void run(Sensor& sensor, Duration duration) {
    for (const auto end = sensor.device_ns + duration.count(); sensor.device_ns < end;) give(sensor.next());
  }
  [[nodiscard]] bool has_event(const std::string& part) const {
    for (const Event& e : monitor.events())
      if (e.what.find(part) != std::string::npos) return true;
    return false;
  }

  Monitor monitor;
  std::unique_ptr<Lidar> lidar;
  std::vector<Scan> scans;
};

inline Config config_for(const Model& model) {
  Config c;
  c.model = model.name;
  c.max_range_m = 300;
  return c;
}

inline bool same(const Scan& a, const Scan& b) {
  return a.valid == b.valid && a.cloud.xyz == b.cloud.xyz && a.cloud.intensity == b.cloud.intensity &&
         a.cloud.offset_ns == b.cloud.offset_ns && a.cloud.ring == b.cloud.ring &&
         a.cloud.return_type == b.cloud.return_type && a.incomplete == b.incomplete && a.partial == b.partial &&
         a.lost_packets == b.lost_packets;
}

}  // namespace cairn::velodyne::test
