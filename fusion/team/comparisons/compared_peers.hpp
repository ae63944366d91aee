// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "fusion/matching/belief/growing_match.hpp"
#include "fusion/peers/items/item.hpp"
#include "fusion/team/comparisons/match_job.hpp"
#include "fusion/team/comparisons/match_worth.hpp"
#include "fusion/team/comparisons/published_edge.hpp"
#include "fusion/team/comparisons/refinements.hpp"
#include "hal/time.hpp"

namespace cairn::team {

/// What was made of the likeliest place. Comparisons are worth their time as long as it changes.
struct PlaceStanding {
  std::optional<matching::Standing> standing{};  ///< none: there is no place
  int agreements = 0;

  friend bool operator==(const PlaceStanding&, const PlaceStanding&) = default;
};

/// What the comparisons of this robot's map with one peer's have come to.
struct ComparedPeer {
  peers::Epoch own_epoch = 0, peer_epoch = 0;       ///< of the maps
  std::uint64_t firm = 0;                           ///< see firmness()
  std::unique_ptr<matching::GrowingMatch> match{};  ///< of the whole maps; null while a job has it
  MatchWorth worth{};                               ///< of the next comparison
  Time refined = Time::min();                       ///< when submaps were last looked for
  PlaceStanding likeliest{};                        ///< of the last comparison
  PublishedEdge edge{};                             ///< what this robot publishes of it
  bool found = false;                               ///< the last comparison found the peer
  bool deployment_refuted = false;                  ///< the last comparison contradicts the deployments
};

/// The peers whose maps are compared with this robot's.
class ComparedPeers {
 public:
  explicit ComparedPeers(const MatchWorthConfig& worth) : worth_(worth) {}

  /// The peer's entry. It begins empty, and is emptied when one of the two robots has begun anew. The
  /// index of its edge stays.
  [[nodiscard]] ComparedPeer& at(peers::RobotId peer, peers::Epoch own_epoch, peers::Epoch peer_epoch);
  /// Firm word has come of where a peer is: what comparisons found before is forgotten. Returns the edge that withdraws
  /// what was published, if anything was. at() knows the peer. `firm`: see firmness(); the same again changes nothing.
  [[nodiscard]] std::optional<IndexedEdge> heed(peers::RobotId peer, std::uint64_t firm);
  /// Null for a peer that at() was never called for.
  [[nodiscard]] const ComparedPeer* find(peers::RobotId peer) const;
  /// The peer that a job is about; null if one of the two robots has begun anew since.
  [[nodiscard]] ComparedPeer* of(const MatchJob& job, peers::Epoch own_epoch);
  [[nodiscard]] std::map<peers::RobotId, ComparedPeer>& all() { return peers_; }
  [[nodiscard]] Refinements& refinements() { return refinements_; }

 private:
  MatchWorthConfig worth_;
  std::map<peers::RobotId, ComparedPeer> peers_;
  Refinements refinements_;
};

}  // namespace cairn::team
