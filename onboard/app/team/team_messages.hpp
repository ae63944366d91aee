// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fusion/team/team.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// The tiles of the robot's own map that some scans changed, as they were after the last of these scans.
struct TileBatch {
  std::uint32_t epoch = 0;             ///< see TrackPoint
  UncertainPose T_odom_base;           ///< at the scan
  Vector6 twist = Vector6::Zero();     ///< of base_link in base_link: m/s, rad/s
  Time stamp{};                        ///< of the scan
  bool lost = false;                   ///< odometry was, at one of the scans
  std::vector<people::Person> people;  ///< around the robot
  std::vector<std::pair<mapping::TileKey, mapping::TileState>> tiles;
};

/// Where teammates are. From the team to mapping.
struct Mates {
  std::uint32_t epoch = 0;  ///< of the odom that they are in
  std::vector<Mate> mates;
};

}  // namespace cairn::app
