// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "fusion/team/comparisons/compared_peers.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "hal/time.hpp"

namespace cairn {

/// Whether a peer's map is a part of the team's map, and why.
struct PeerStanding {
  bool merged = false;
  std::string reason;  ///< for people; docs/team.md lists the reasons and the remedies
};

/// What people ask when two maps do not merge. `least_tiles`: with something occupied, that both maps
/// need to be compared.
[[nodiscard]] PeerStanding standing_of(peers::RobotId peer, const TeamView& team, const ComparedPeers& compared,
                                       std::size_t least_tiles, Time now);

}  // namespace cairn
