// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "drivers/recording/formats/recording.hpp"
#include "hal/packet.hpp"
#include "hal/point_cloud.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// Takes the packets of a camera, a thermal or depth camera, a CAN bus, GPIO lines or a team through the drivers'
/// decoders and keeps what a person wants to know of them.
class SensorFigures {
 public:
  virtual ~SensorFigures() = default;
  /// The points that the packet gave, if its sensor gives points; valid until the next call.
  virtual Result<const Scan*> take(const Packet& packet) = 0;
  [[nodiscard]] virtual report::Json to_json() const = 0;
};

/// For the kinds that are neither velodyne nor scans. Error: a model that no driver knows.
[[nodiscard]] Result<std::unique_ptr<SensorFigures>> make_sensor_figures(const recording::SourceEntry& entry);

}  // namespace cairn::cli
