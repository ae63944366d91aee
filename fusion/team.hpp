// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/matching/growing_match.hpp"
#include "fusion/merging/team_map.hpp"
#include "fusion/peers/claim.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/own_tiles.hpp"
#include "fusion/team_graph.hpp"
#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn {

struct TeamConfig {
  peers::RobotId id = 0;  ///< of this robot, its own in the team, not 0
  std::string name;       ///< for people
  double resolution_m = 0.2;
  merging::Policy policy = merging::Policy::kRelativeEntropy;
  peers::ExchangeConfig exchange;
  peers::OwnTilesConfig own_tiles;
  Duration match_period = std::chrono::seconds(5);  ///< of one pair, at least
  double match_growth = 1.15;                       ///< the maps' since the pair was last compared, at least
  std::size_t least_tiles = 60;                     ///< with something occupied, on both sides, to be compared at all
};

/// Two maps to be compared, away from everyone else's work, and what is known of the pair.
struct MatchJob {
  peers::RobotId peer = 0;
  peers::Epoch own_epoch = 0, peer_epoch = 0;
  std::shared_ptr<const SemanticOcTree> own, other;
  std::unique_ptr<matching::GrowingMatch> match;
};
/// Does the job: seconds, for a machine that has nothing else to do.
void run(MatchJob& job, Budget& budget);

/// Why a peer's map is, or is not, a part of the team's.
struct PeerStanding {
  bool merged = false;
  std::string reason;  ///< for people
};

/// A robot's part in a team: says what it sees, hears what others say, finds where they are, and holds the map of all.
/// Whoever has the same newest tiles and edges has the same team map, to the byte. Pure: no clock, no thread; what
/// takes long (comparing maps) is handed out as a job, what can be cut into slices (fusing) is.
class Team {
 public:
  Team(const TeamConfig& config, peers::Epoch epoch);

  /// A tile of one's own map has changed; odom frame, of this epoch.
  void observe(TileKey tile, const TileState& state, Time now) { own_tiles_.observe(tile, state, now); }
  /// A datagram of a peer.
  Result<void> receive(std::span<const std::byte> datagram, Time now) { return exchange_.receive(datagram, now); }
  /// To be called often (some ten times a second); datagrams to be sent are appended.
  void step(Time now, std::vector<peers::Outgoing>& out);

  /// The comparison that is most worth its time now, if any is. One at a time is out.
  [[nodiscard]] std::optional<MatchJob> next_match(Time now);
  /// A job that was run. Maps that have begun anew meanwhile make it void.
  void matched(MatchJob job);

  /// Goes on with the team's map; true: it is up to date.
  bool fuse(Budget& budget) { return map_.fuse(budget); }

  [[nodiscard]] const merging::TeamMap& map() const { return map_; }
  [[nodiscard]] const TeamPoses& poses() const { return poses_; }
  [[nodiscard]] PeerStanding standing(peers::RobotId peer, Time now) const;
  [[nodiscard]] const peers::Exchange& exchange() const { return exchange_; }

 private:
  /// A robot's tiles as a tree, to be compared.
  struct Mapped {
    std::shared_ptr<SemanticOcTree> tree;
    std::size_t occupied_tiles = 0;
  };
  /// What is known about the pair with a peer.
  struct Pair {
    peers::Epoch own_epoch = 0, peer_epoch = 0;
    std::unique_ptr<matching::GrowingMatch> match;  // null while a job has it
    Time last = Time::min();
    std::size_t own_tiles = 0, peer_tiles = 0;  // when it was last compared
    std::uint16_t edge = 0;                     // index of the item that says what came of it
    std::optional<peers::Edge> said;
  };

  void take_news(Time now);
  void take_tile(peers::RobotId robot, peers::ItemId id, Time now);
  void agree();
  [[nodiscard]] std::vector<PairClaim> claims() const;
  [[nodiscard]] Pair& pair_with(peers::RobotId peer, peers::Epoch epoch);
  [[nodiscard]] bool worth_comparing(peers::RobotId peer, const Pair& pair, Time now) const;
  void say_edge(peers::RobotId peer, Pair& pair);

  TeamConfig config_;
  peers::Exchange exchange_;
  peers::OwnTiles own_tiles_;
  std::map<peers::RobotId, Mapped> mapped_;
  std::map<peers::RobotId, Pair> pairs_;
  bool match_out_ = false, edges_changed_ = true;
  TeamPoses poses_;
  merging::TeamMap map_;
};

}  // namespace cairn
