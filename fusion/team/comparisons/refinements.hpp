// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "fusion/peers/items/claim.hpp"
#include "fusion/team/graph/team_graph.hpp"
#include "fusion/team/tiles/robot_tiles.hpp"

namespace cairn {

/// A submap of this robot and one of a peer, which were found to overlap.
struct SubmapPair {
  peers::RobotId peer = 0;
  std::uint16_t own = 0, other = 0;
  friend constexpr auto operator<=>(const SubmapPair&, const SubmapPair&) = default;
};

/// Which submaps of two robots are worth a comparison from where the team's graph puts them, and what came of those
/// that were compared. For each submap that is the one of the other robot with which it has most tiles in common, so
/// that there are no more comparisons than submaps, up to a few each: again, when they have half as much more in
/// common.
class Refinements {
 public:
  static constexpr std::uint16_t kFirstEdge = 0x4000, kMost = 0x4000;  ///< indices of what is said

  /// The next to be compared; it counts as compared then. `own` and `other` are parts of the team.
  [[nodiscard]] std::optional<SubmapPair> next(peers::RobotId self, peers::RobotId peer, const RobotTiles& own,
                                               const RobotTiles& other, const TeamPoses& poses, double tile_m);
  /// The index of the edge that says what came of it.
  [[nodiscard]] std::uint16_t edge_of(const SubmapPair& pair) const { return compared_.at(pair).edge; }
  [[nodiscard]] std::optional<peers::Edge>& said(const SubmapPair& pair) { return compared_.at(pair).said; }
  /// The peer has begun anew.
  void forget(peers::RobotId peer);
  void clear() { compared_.clear(); }

 private:
  struct Comparison {
    std::size_t common = 0;  // tiles, when it was compared
    std::uint16_t edge = 0;
    std::optional<peers::Edge> said;
  };
  std::map<SubmapPair, Comparison> compared_;
};

}  // namespace cairn
