// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "fusion/peers/items/item.hpp"
#include "fusion/team/tiles/robot_tiles.hpp"

namespace cairn::team {

/// Which tiles each robot has published, in which of its submaps.
class TeamTiles {
 public:
  /// A robot published a tile as part of a submap. `occupied`: the tile holds something occupied.
  /// Returns the submap that the tile was in before, if that is another one.
  std::optional<std::uint16_t> put(peers::RobotId robot, mapping::TileKey tile, std::uint16_t submap, bool occupied);
  /// The robot has begun anew: its tiles are void. Its version stays.
  void forget(peers::RobotId robot) { tiles_.erase(robot); }

  /// Empty for a robot that has published nothing.
  [[nodiscard]] const RobotTiles& of(peers::RobotId robot) const;
  /// How many of the robot's tiles hold something occupied.
  [[nodiscard]] std::size_t walls_of(peers::RobotId robot) const { return of(robot).walls(); }
  /// How many tiles the robot has ever published: the same number means the same map.
  [[nodiscard]] std::uint64_t version_of(peers::RobotId robot) const;

 private:
  std::map<peers::RobotId, RobotTiles> tiles_;
  std::map<peers::RobotId, std::uint64_t> versions_;
};

}  // namespace cairn::team
