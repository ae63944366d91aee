// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_outlook.hpp"

#include <algorithm>
#include <cmath>

#include "fusion/team/comparisons/deployments.hpp"

namespace cairn::team {
namespace {

constexpr double kLikely = 0.5;       // probability: the place is rather right than wrong
constexpr std::size_t kSample = 128;  // tiles of b: the share is right to a few percent
constexpr int kEdge = 1 << mapping::TileKey::kVoxelBits,
              kMiddle = 32768;  // voxels: of a tile, from key 0 to the origin

/// The tile at a place of the map, which is in voxels from the origin. Beyond the map: its last tile.
mapping::TileKey tile_at(const Eigen::Vector3d& voxels) {
  const auto key = [&](int axis) {
    return static_cast<std::uint16_t>(std::clamp(std::floor(voxels[axis]) + kMiddle, 0.0, 65535.0));
  };
  return mapping::TileKey::of_voxel(key(0), key(1), key(2));
}

/// The two grids are turned against each other, so a tile's walls may be in the next tile.
bool meets(const std::set<mapping::TileKey>& tiles, const Eigen::Vector3d& voxels) {
  if (tiles.contains(tile_at(voxels))) return true;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-kEdge / 2.0, kEdge / 2.0})
      if (tiles.contains(tile_at(voxels + side * Eigen::Vector3d::Unit(axis)))) return true;
  return false;
}

}  // namespace

MatchOutlook outlook_of(const TeamView& team, peers::RobotId peer, const matching::PendingHypotheses& places) {
  const RobotTiles &own = team.tiles.of(team.self()), &other = team.tiles.of(peer);
  MatchOutlook outlook{.own_tiles = own.walls(),
                       .peer_tiles = other.walls(),
                       .own_version = team.tiles.version_of(team.self()),
                       .peer_version = team.tiles.version_of(peer),
                       .merged = team.poses.T_team_odom.contains(peer)};
  if (const auto T_own_peer = likely_pose(team, peer, places))
    outlook.common_tiles = tiles_of_both(own.all_walls(), other.all_walls(), *T_own_peer, team.resolution_m);
  return outlook;
}

std::optional<SE3> likely_pose(const TeamView& team, peers::RobotId peer, const matching::PendingHypotheses& places) {
  if (const auto T_own_peer = team.poses.odom_between(team.self(), peer)) return T_own_peer;
  const auto all = places.all();
  if (!all.empty() && all.front().probability_correct >= kLikely) return all.front().T_a_b.mean;
  const auto guess = deployed_between(team.exchange.layers(), team.self(), peer);
  const double tile_m = team.tile_m();
  if (!guess || guess->covariance.diagonal().head<3>().maxCoeff() > tile_m * tile_m) return std::nullopt;
  return guess->mean;
}

std::size_t tiles_of_both(const std::set<mapping::TileKey>& a, const std::set<mapping::TileKey>& b, const SE3& T_a_b,
                          double resolution_m) {
  const std::size_t step = std::max<std::size_t>(1, (b.size() + kSample - 1) / kSample);
  std::size_t common = 0, i = 0;
  for (const mapping::TileKey tile : b) {
    if (i++ % step != 0) continue;
    Eigen::Vector3d middle;
    for (unsigned axis = 0; axis < 3; ++axis) middle[axis] = tile.first_voxel(axis) - kMiddle + kEdge / 2.0;
    common += meets(a, T_a_b * (resolution_m * middle) / resolution_m) ? step : 0;
  }
  return std::min(common, b.size());
}

}  // namespace cairn::team
