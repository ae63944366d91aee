// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>

#include "fusion/matching/belief/pending.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/map_tile.hpp"

namespace cairn::team {

/// What is known of two maps before they are compared.
struct MatchOutlook {
  std::size_t own_tiles = 0, peer_tiles = 0;        ///< with something occupied
  std::optional<std::size_t> common_tiles{};        ///< that both have seen; nothing if no pose is likely
  std::uint64_t own_version = 0, peer_version = 0;  ///< see TeamTiles::version_of()
  bool merged = false;  ///< the peer is in the team: a comparison can confirm, refine or withdraw it
};

/// `places`: what earlier comparisons of the two maps have found.
[[nodiscard]] MatchOutlook outlook_of(const TeamView& team, peers::RobotId peer,
                                      const matching::PendingHypotheses& places);

/// Where the peer's odom frame lies in this robot's, to a tile. It is taken from the team's poses, else
/// from the likeliest place of earlier comparisons, else from where the two were put down.
[[nodiscard]] std::optional<SE3> likely_pose(const TeamView& team, peers::RobotId peer,
                                             const matching::PendingHypotheses& places);

/// About how many tiles of b meet tiles of a; T_a_b is where b lies in a. A sample, if b has many.
[[nodiscard]] std::size_t tiles_of_both(const std::set<mapping::TileKey>& a, const std::set<mapping::TileKey>& b,
                                        const SE3& T_a_b, double resolution_m);

}  // namespace cairn::team
