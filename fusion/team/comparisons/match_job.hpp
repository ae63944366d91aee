// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "fusion/matching/belief/growing_match.hpp"
#include "fusion/peers/items/item.hpp"
#include "fusion/team/comparisons/refinements.hpp"
#include "fusion/team/tiles/published_tiles.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"

namespace cairn::team {

/// Two submaps to be compared. Their maps are in the submaps' own frames.
struct Refinement {
  SubmapPair submaps;
  UncertainPose guess{};                 ///< T_own_other of the submaps, by the team's graph
  std::optional<UncertainPose> found{};  ///< T_own_other, if it is sure and agrees with the guess
  double probability = 0;                ///< that `found` is right, 0…1
};

/// Two maps to be compared, and what is known of the pair. It owns all it needs, so another thread
/// can run it.
struct MatchJob {
  peers::RobotId peer = 0;
  peers::Epoch own_epoch = 0, peer_epoch = 0;       ///< of the maps
  std::uint64_t firm = 0;                           ///< see firmness()
  PublishedTiles own{}, other{};                    ///< this robot's and the peer's
  std::unique_ptr<matching::GrowingMatch> match{};  ///< for whole maps; null for submaps
  std::optional<UncertainPose> guess{};             ///< T_own_other, for whole maps
  std::optional<Refinement> refinement{};           ///< for submaps
  bool ran = false;                                 ///< run() has done it
};
/// Does the job. It takes seconds: run it where nothing waits for it.
void run(MatchJob& job, Budget& budget);

}  // namespace cairn::team
