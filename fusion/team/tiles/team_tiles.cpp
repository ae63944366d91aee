// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/tiles/team_tiles.hpp"

namespace cairn::team {

std::optional<std::uint16_t> TeamTiles::put(peers::RobotId robot, mapping::TileKey tile, std::uint16_t submap,
                                            bool occupied) {
  ++versions_[robot];
  return tiles_[robot].put(tile, submap, occupied);
}

const RobotTiles& TeamTiles::of(peers::RobotId robot) const {
  static const RobotTiles none;
  const auto found = tiles_.find(robot);
  return found == tiles_.end() ? none : found->second;
}

std::uint64_t TeamTiles::version_of(peers::RobotId robot) const {
  const auto found = versions_.find(robot);
  return found == versions_.end() ? 0 : found->second;
}

}  // namespace cairn::team
