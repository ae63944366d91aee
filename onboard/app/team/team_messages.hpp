// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fusion/team/team.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "onboard/scheduler/channel.hpp"

namespace cairn {

/// What some scans changed in the robot's own map, as it was after the last of them.
struct TileBatch {
  std::uint32_t epoch = 0;    ///< see TrackPoint
  UncertainPose T_odom_base;  ///< at the scan
  std::vector<std::pair<TileKey, TileState>> tiles;
};

using TileChannel = scheduler::Channel<TileBatch>;
using MatchChannel = scheduler::Channel<MatchJob>;

}  // namespace cairn
