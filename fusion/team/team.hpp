// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/matching/belief/growing_match.hpp"
#include "fusion/merging/team_map.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/own_submaps.hpp"
#include "fusion/peers/own_tiles.hpp"
#include "fusion/team/match_job.hpp"
#include "fusion/team/match_worth.hpp"
#include "fusion/team/peer_state.hpp"
#include "fusion/team/refinements.hpp"
#include "fusion/team/robot_tiles.hpp"
#include "fusion/team/team_graph.hpp"
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
  peers::OwnSubmapsConfig own_submaps;
  MatchWorthConfig match;
  std::size_t least_tiles = 60;             ///< with something occupied, on both sides, to be compared at all
  std::optional<UncertainPose> deployment;  ///< T_site_odom of its first beginning: see peers::Deployment
};

/// Why a peer's map is, or is not, a part of the team's.
struct PeerStanding {
  PeerState state = PeerState::kNeverHeard;
  std::string reason;                    ///< for people: the state in words, with figures
  bool deployment_contradicted = false;  ///< the deployments of the two do not fit to their maps

  [[nodiscard]] bool merged() const { return state == PeerState::kMerged; }
};

/// A robot's part in a team: says what it sees, hears what others say, finds where they are, and holds the map of all.
/// Whoever has the same newest tiles and edges has the same team map, to the byte. Pure: no clock, no thread; what
/// takes long (comparing maps) is handed out as a job, what can be cut into slices (fusing) is.
class Team {
 public:
  Team(const TeamConfig& config, peers::Epoch epoch);
  Team(Team&&) = delete;
  Team& operator=(Team&&) = delete;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() = default;

  /// One's own map begins anew; what was said of it is void, where the robot was put down too: the new odom frame lies
  /// where it is now. `epoch` is higher than the last.
  void begin(peers::Epoch epoch);
  /// Where the robot is: peers are told, the team's map is brought up to date there first, and the way from one place
  /// to the next is what odometry may drift along.
  void be_at(const UncertainPose& T_odom_base);
  /// A tile of one's own map has changed; odom frame, of this epoch. It is said as a part of the present submap.
  void observe(TileKey tile, const TileState& state, Time now) {
    own_tiles_.observe(tile, state, now, own_submaps_.current());
  }
  /// Where a peer's odom frame lies in this robot's by something else than their maps: a survey, a marker both saw.
  /// Said to all, for every beginning of either, until it is claimed otherwise; it must agree with what the maps say.
  void claim(peers::RobotId peer, const UncertainPose& T_own_peer, double probability) {
    known_poses_[peer] = {T_own_peer, static_cast<float>(probability)};
  }
  /// A datagram of a peer.
  Result<void> receive(std::span<const std::byte> datagram, Time now) { return exchange_.receive(datagram, now); }
  /// To be called often (some ten times a second); datagrams to be sent are appended.
  void step(Time now, std::vector<peers::Outgoing>& out);

  /// The comparison that is most worth its time now, if any is. One at a time is out.
  [[nodiscard]] std::optional<MatchJob> next_match(Time now);
  /// A job that was run, or for which there was no time. Maps that have begun anew meanwhile make it void.
  void matched(MatchJob job, Time now);

  /// Goes on with the team's map; true: it is up to date.
  bool fuse(Budget& budget) { return map_.fuse(budget); }

  /// Tiles of its own map that wait to be said.
  [[nodiscard]] std::size_t unsaid() const { return own_tiles_.waiting(); }
  [[nodiscard]] const merging::TeamMap& map() const { return map_; }
  [[nodiscard]] const TeamPoses& poses() const { return poses_; }
  /// What everyone says of where others are, taken back ones left out.
  [[nodiscard]] std::vector<PairClaim> claims() const;
  [[nodiscard]] PeerStanding standing(peers::RobotId peer, Time now) const;
  [[nodiscard]] const peers::Exchange& exchange() const { return exchange_; }

 private:
  /// What was made of the likeliest place. Comparisons are worth their time as long as it changes.
  struct PlaceStanding {
    std::optional<matching::Standing> standing;  // none: there is no place
    int agreements = 0;
    friend bool operator==(const PlaceStanding&, const PlaceStanding&) = default;
    static PlaceStanding of(const matching::GrowingMatch& match) {
      const auto places = match.hypotheses().all();
      return places.empty() ? PlaceStanding{} : PlaceStanding{places.front().standing, places.front().agreements};
    }
  };
  /// What is known about the pair with a peer.
  struct Pair {
    peers::Epoch own_epoch = 0, peer_epoch = 0;
    std::unique_ptr<matching::GrowingMatch> match;  // null while a job has it
    MatchWorth worth;
    Time refined = Time::min();
    PlaceStanding standing;  // when it was last compared
    std::uint16_t edge = 0;  // index of the item that says what came of it
    std::optional<peers::Edge> said;
    bool found = false, deployment_refuted = false;  // by the maps, when they were last compared
  };

  [[nodiscard]] std::optional<PeerStanding> obstacle(peers::RobotId peer, Time now) const;
  void say_known_poses();
  /// Where the peer's odom frame lies by the deployments of both; nothing where one of them has none.
  [[nodiscard]] std::optional<UncertainPose> deployed(peers::RobotId peer) const;
  void say_deployments();
  void weigh_deployment(peers::RobotId peer, Pair& pair) const;
  /// What the maps say against it, for people; empty: nothing.
  [[nodiscard]] std::string deployment_fault(peers::RobotId peer) const;
  void take_news(Time now);
  void take_tile(peers::RobotId robot, peers::ItemId id, Time now);
  void agree();
  void focus();
  [[nodiscard]] peers::Interest interest_of(peers::RobotId peer, peers::RobotId robot) const;
  [[nodiscard]] Pair& pair_with(peers::RobotId peer, peers::Epoch epoch);
  [[nodiscard]] std::size_t walls_of(peers::RobotId robot) const;
  [[nodiscard]] double tile_m() const { return kTileEdge * config_.resolution_m; }
  [[nodiscard]] SubmapChains chains() const;
  [[nodiscard]] bool known_submap(peers::RobotId robot, std::uint16_t submap) const;
  [[nodiscard]] std::map<std::uint16_t, SE3> undrifted(peers::RobotId robot) const;
  [[nodiscard]] SaidTiles said_by(peers::RobotId robot, std::optional<std::uint16_t> submap = {}) const;
  [[nodiscard]] MatchOutlook outlook(peers::RobotId peer, const Pair& pair) const;
  [[nodiscard]] std::optional<SE3> believed(peers::RobotId peer, const Pair& pair) const;
  [[nodiscard]] std::optional<MatchJob> next_refinement(Time now);
  [[nodiscard]] peers::Edge edge_of(const MatchJob& job, const UncertainPose& T_own_other) const;
  void say_edge(const MatchJob& job, Pair& pair);
  void say_refined(const Refinement& refinement, peers::Epoch peer_epoch);

  TeamConfig config_;
  peers::Exchange exchange_;
  peers::OwnTiles own_tiles_;
  peers::OwnSubmaps own_submaps_;
  std::map<peers::RobotId, RobotTiles> tiles_;
  std::map<peers::RobotId, std::uint64_t> tile_news_;  // how many there were
  std::map<peers::RobotId, Pair> pairs_;
  std::map<peers::RobotId, std::pair<UncertainPose, float>> known_poses_;  // and their probability
  bool match_out_ = false, edges_changed_ = true;
  TeamPoses poses_;
  SubmapChains chains_;  // that the poses were found with
  Refinements refinements_;
  Eigen::Vector3d position_odom_ = Eigen::Vector3d::Zero();
  merging::TeamMap map_;
};

}  // namespace cairn
