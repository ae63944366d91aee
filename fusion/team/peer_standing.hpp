// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "fusion/team/comparisons/compared_peers.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "fusion/team/peer_state.hpp"
#include "hal/time.hpp"

namespace cairn::team {

/// Whether a peer's map is a part of the team's map, and why.
struct PeerStanding {
  PeerState state = PeerState::kNeverHeard;
  std::string reason;  ///< for people: the state in words, with figures; docs/team.md lists the remedies
  bool deployment_contradicted = false;  ///< the deployments of the two do not fit to their maps

  [[nodiscard]] bool merged() const { return state == PeerState::kMerged; }
};

/// What people ask when two maps do not merge. `least_tiles`: with something occupied, that both maps
/// need to be compared.
[[nodiscard]] PeerStanding standing_of(peers::RobotId peer, const TeamView& team, const ComparedPeers& compared,
                                       std::size_t least_tiles, Time now);

}  // namespace cairn::team
