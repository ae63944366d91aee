// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/peers/exchange.hpp"
#include "fusion/team/graph/team_graph.hpp"
#include "fusion/team/tiles/team_tiles.hpp"
#include "onboard/mapping/tree/tile_voxels.hpp"

namespace cairn::team {

/// What a robot knows of its team by now. Everything that decides by it takes one. It refers to what
/// the robot holds, so it is valid during one call.
struct TeamView {
  const peers::Exchange& exchange;
  const TeamTiles& tiles;
  const TeamPoses& poses;
  const SubmapChains& chains;  ///< that the poses were found with
  double resolution_m;         ///< edge of a voxel, the same for all robots

  [[nodiscard]] peers::RobotId self() const { return exchange.self(); }
  [[nodiscard]] double tile_m() const { return mapping::kTileEdge * resolution_m; }  ///< edge of a tile
};

}  // namespace cairn::team
