// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fusion/team/team.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::app {

/// The tiles of the robot's own map that some scans changed, as they were after the last of these scans.
struct TileBatch {
  std::uint32_t epoch = 0;    ///< see TrackPoint
  UncertainPose T_odom_base;  ///< at the scan
  std::vector<std::pair<mapping::TileKey, mapping::TileState>> tiles;
};

}  // namespace cairn::app
