// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/team_positions.hpp"

#include <deque>

#include "fusion/team/tiles/published_tiles.hpp"

namespace cairn::team {
namespace {

constexpr std::size_t kAnchor = 0;  // node of the anchor's first submap

/// How surely the odom frame of a submap lies in the team's frame: covariance of a right perturbation.
Matrix6 covariance_of(const PoseGraph& graph, const Marginals& marginals, std::size_t node, const SE3& T_team_odom) {
  const Matrix6 at_odom = (T_team_odom.inverse() * graph.poses[node]).adjoint();
  return at_odom * marginals.between(kAnchor, node).covariance * at_odom.transpose();
}

}  // namespace

Result<std::vector<merging::VoxelPosition>> team_positions(const Team& team) {
  const TeamPoses& poses = team.poses();
  const mapping::SemanticOcTree& fused = team.map().map();
  const Marginals marginals(poses.graph);
  std::deque<mapping::SemanticOcTree> maps;
  std::vector<merging::PlacedMap> placed;
  for (const auto& [submap, T_team_odom] : team.map().poses()) {
    const auto node = poses.nodes.find(submap);
    const auto layer = team.exchange().layers().find(submap.robot);
    if (node == poses.nodes.end() || layer == team.exchange().layers().end()) continue;
    const auto tiles = PublishedTiles::of(layer->second.holding, fused.getResolution(), submap.submap);
    placed.push_back({.map = &maps.emplace_back(tiles.map()),
                      .T_fused_map = {T_team_odom, covariance_of(poses.graph, marginals, node->second, T_team_odom)}});
  }
  return merging::voxel_positions(fused, placed);
}

}  // namespace cairn::team
