// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "fusion/peers/items/item.hpp"
#include "fusion/team/comparisons/published_edge.hpp"
#include "fusion/team/graph/team_graph.hpp"
#include "fusion/team/tiles/robot_tiles.hpp"

namespace cairn::team {

/// A submap of this robot and one of a peer that overlap.
struct SubmapPair {
  peers::RobotId peer = 0;
  std::uint16_t own = 0, other = 0;
  friend constexpr auto operator<=>(const SubmapPair&, const SubmapPair&) = default;
};

/// Which submaps of two robots are worth a comparison, from where the team's graph puts them, and what
/// was published of those that were compared.
/// - A submap is compared with the submap of the other robot that it has most tiles in common with.
/// - The two are compared again when they have half as many more tiles in common.
/// So there are a few comparisons of each submap at most.
class Refinements {
 public:
  /// The next pair to be compared. It counts as compared from now on. Both robots are in the team, and
  /// `tile_m` is the edge of a tile.
  [[nodiscard]] std::optional<SubmapPair> next(peers::RobotId self, peers::RobotId peer, const RobotTiles& own,
                                               const RobotTiles& other, const TeamPoses& poses, double tile_m);
  /// What is published of a pair that next() has returned; null if it is void since.
  [[nodiscard]] PublishedEdge* edge(const SubmapPair& pair);
  /// The peer has begun anew: all its submaps may be compared again.
  void forget(peers::RobotId peer);
  /// This robot has begun anew.
  void clear() { compared_.clear(); }

 private:
  struct Comparison {
    std::size_t common = 0;  // tiles, when it was compared
    PublishedEdge edge;
  };
  std::map<SubmapPair, Comparison> compared_;
};

}  // namespace cairn::team
