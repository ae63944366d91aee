// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/submap_edge.hpp"

namespace cairn::team {
namespace {

/// Two submaps, and how much of them lies on each other.
struct Shared {
  std::uint16_t own = 0, other = 0;
  std::size_t tiles = 0;
};

bool placed(const TeamView& team, peers::RobotId robot, std::uint16_t submap) {
  return submap < submaps_of(team.chains, robot);
}

Shared most_shared(const MatchJob& job, const SE3& T_own_other, const TeamView& team) {
  Shared most;
  for (const auto& [own, own_walls] : team.tiles.of(team.self()).walls_by_submap())
    for (const auto& [other, other_walls] : team.tiles.of(job.peer).walls_by_submap()) {
      const SE3 T_own = job.own.T_map_odom_of(own), T_other = job.other.T_map_odom_of(other);
      const SE3 T_other_own = (T_own.inverse() * T_own_other * T_other).inverse();  // of the odom frames
      const std::size_t tiles = common_tiles(own_walls, other_walls, T_other_own, team.tile_m());
      if (tiles <= most.tiles || !placed(team, team.self(), own) || !placed(team, job.peer, other)) continue;
      most = {.own = own, .other = other, .tiles = tiles};
    }
  return most;
}

}  // namespace

peers::Edge submap_edge(const MatchJob& job, const UncertainPose& T_own_other, const TeamView& team) {
  const Shared most = most_shared(job, T_own_other.mean, team);
  peers::Edge edge{.own_submap = most.own,
                   .other = job.peer,
                   .other_epoch = job.peer_epoch,
                   .other_submap = most.other,
                   .T_own_other = T_own_other,
                   .probability = 0};
  if (most.own == 0 && most.other == 0) return edge;  // the maps' frames are those of their first submaps
  const SE3 T_own_submap = job.own.T_map_odom_of(most.own) * place_in_odom(team.chains, team.self(), most.own);
  const SE3 T_other_submap = job.other.T_map_odom_of(most.other) * place_in_odom(team.chains, job.peer, most.other);
  const Matrix6 adjoint = T_other_submap.inverse().adjoint();
  edge.T_own_other = {T_own_submap.inverse() * T_own_other.mean * T_other_submap,
                      adjoint * T_own_other.covariance * adjoint.transpose()};
  return edge;
}

}  // namespace cairn::team
