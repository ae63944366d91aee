// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "fusion/matching/belief/growing_match.hpp"
#include "fusion/peers/items/item.hpp"
#include "fusion/team/comparisons/refinements.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn {

/// A robot's tiles as they were said: small enough to be copied for whoever makes a map of them.
struct SaidTiles {
  struct Tile {
    TileKey key;
    std::uint16_t submap = 0;
    std::size_t begin = 0, bytes = 0;  ///< in `payloads`
  };
  double resolution_m = 0;
  std::vector<Tile> tiles;
  std::vector<std::byte> payloads;
  /// Where odom lies in the map as far as a submap's tiles go; where it is not there, odom is the map's frame.
  std::map<std::uint16_t, SE3> T_map_odom;

  [[nodiscard]] SE3 T_map_odom_of(std::uint16_t submap) const;
  [[nodiscard]] SemanticOcTree map() const;
};

/// Two submaps to be compared, and where one lies in the other by all that is known; the maps are in the submaps'
/// frames.
struct Refinement {
  SubmapPair submaps;
  UncertainPose guess;
  std::optional<UncertainPose> found;  ///< what is sure, and agrees with the guess
  double probability = 0;
};

/// Two maps to be compared, away from everyone else's work, and what is known of the pair. It owns all it needs.
struct MatchJob {
  peers::RobotId peer = 0;
  peers::Epoch own_epoch = 0, peer_epoch = 0;
  SaidTiles own, other;
  std::unique_ptr<matching::GrowingMatch> match;  ///< of whole maps; null of submaps
  std::optional<UncertainPose> guess;             ///< T_own_other, of whole maps
  std::optional<Refinement> refinement;           ///< of submaps
  bool ran = false;
};
/// Does the job: seconds, for a machine that has nothing else to do.
void run(MatchJob& job, Budget& budget);

}  // namespace cairn
