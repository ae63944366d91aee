// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "fusion/peers/exchange.hpp"
#include "fusion/team/graph/indexed_edge.hpp"
#include "hal/se3.hpp"

namespace cairn::team {

/// Where peers lie by something else than maps: a survey, a marker that both robots saw.
class SurveyedPoses {
 public:
  /// Where the peer's odom frame lies in this robot's. It replaces what was set before. `probability`:
  /// that it is right, 0…1.
  void set(peers::RobotId peer, const UncertainPose& T_own_peer, double probability) {
    poses_[peer] = {.T_own_peer = T_own_peer, .probability = static_cast<float>(probability)};
  }
  /// The edges to be published, about the present beginnings of the peers that have been heard of.
  [[nodiscard]] std::vector<IndexedEdge> edges(const peers::Layers& layers) const;

 private:
  struct Surveyed {
    UncertainPose T_own_peer;
    float probability = 0;
  };
  std::map<peers::RobotId, Surveyed> poses_;
};

}  // namespace cairn::team
