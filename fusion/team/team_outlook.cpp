// SPDX-License-Identifier: Apache-2.0
// What a robot of a team expects of comparing its map with a peer's.
#include <algorithm>

#include "fusion/team/team.hpp"

namespace cairn {

/// Where the peer's odom frame lies, to a tile: by the team's poses, else by the last comparison, else by where the two
/// were put down.
std::optional<SE3> Team::believed(peers::RobotId peer, const Pair& pair) const {
  constexpr double kLikely = 0.5;
  const auto own = poses_.T_team_odom.find(config_.id), other = poses_.T_team_odom.find(peer);
  if (own != poses_.T_team_odom.end() && other != poses_.T_team_odom.end())
    return own->second.inverse() * other->second;
  const auto places = pair.match->hypotheses().all();
  if (!places.empty() && places.front().probability_correct >= kLikely) return places.front().T_a_b.mean;
  const auto guess = deployed(peer);
  const double tile_m = config_.resolution_m * (1 << TileKey::kVoxelBits);
  if (!guess || guess->covariance.diagonal().head<3>().maxCoeff() > tile_m * tile_m) return std::nullopt;
  return guess->mean;
}

MatchOutlook Team::outlook(peers::RobotId peer, const Pair& pair) const {
  const auto news_of = [&](peers::RobotId robot) {
    const auto news = tile_news_.find(robot);
    return news != tile_news_.end() ? news->second : 0;
  };
  MatchOutlook known{walls_of(config_.id), walls_of(peer), {},
                     news_of(config_.id),  news_of(peer),  poses_.T_team_odom.contains(peer)};
  if (const auto T_own_peer = believed(peer, pair))
    known.common_tiles = tiles_of_both(tiles_.at(config_.id).all_walls(), tiles_.at(peer).all_walls(), *T_own_peer,
                                       config_.resolution_m);
  return known;
}

}  // namespace cairn
