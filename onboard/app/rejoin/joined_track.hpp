// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "onboard/robot.hpp"

namespace cairn::app {

/// The robot's poses. Those of maps that were joined to the last one are given in its frame, others in their own.
[[nodiscard]] std::vector<TrackPoint> joined_track(const Robot& robot);

/// The file in a run's folder that keeps the map of an epoch that has ended.
[[nodiscard]] inline std::string earlier_map_file(std::uint32_t epoch) {
  return "map-epoch-" + std::to_string(epoch) + ".cairn";
}

}  // namespace cairn::app
