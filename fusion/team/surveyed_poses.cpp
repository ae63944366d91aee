// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/surveyed_poses.hpp"

namespace cairn::team {

std::vector<IndexedEdge> SurveyedPoses::edges(const peers::Layers& layers) const {
  std::vector<IndexedEdge> edges;
  std::size_t nth = 0;
  for (const auto& [peer, surveyed] : poses_) {
    const std::uint16_t index = edge_index(EdgeOrigin::kSurveyed, nth++);
    const auto layer = layers.find(peer);
    if (layer == layers.end()) continue;
    edges.push_back({index,
                     {.own_submap = 0,
                      .other = peer,
                      .other_epoch = layer->second.epoch,
                      .other_submap = 0,
                      .T_own_other = surveyed.T_own_peer,
                      .probability = surveyed.probability}});
  }
  return edges;
}

}  // namespace cairn::team
