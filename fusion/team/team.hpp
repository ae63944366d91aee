// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fusion/merging/team_map.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/own_submaps.hpp"
#include "fusion/peers/own_tiles.hpp"
#include "fusion/peers/submap_check.hpp"
#include "fusion/team/comparisons/compared_peers.hpp"
#include "fusion/team/comparisons/match_job.hpp"
#include "fusion/team/comparisons/match_plan.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "fusion/team/graph/published_claims.hpp"
#include "fusion/team/graph/team_graph.hpp"
#include "fusion/team/peer_bodies.hpp"
#include "fusion/team/peer_standing.hpp"
#include "fusion/team/surveyed_poses.hpp"
#include "fusion/team/tiles/team_tiles.hpp"
#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::team {

/// A robot's part in a team: who it is, and how it exchanges and compares maps.
struct TeamConfig {
  peers::RobotId id = 0;      ///< of this robot: its own in the team, not 0
  std::string name;           ///< of this robot, for people
  double resolution_m = 0.2;  ///< edge of a voxel; robots with other voxels are not merged
  merging::Policy policy = merging::Policy::kRelativeEntropy;
  peers::ExchangeConfig exchange;
  peers::OwnTilesConfig own_tiles;
  peers::OwnSubmapsConfig own_submaps;
  MatchWorthConfig match;
  std::size_t least_tiles = 60;  ///< with something occupied, that both maps need to be compared
  /// T_site_odom of the robot's first beginning, if it is known: see peers::Deployment.
  std::optional<UncertainPose> deployment;
};

/// A robot's part in a team. It publishes what the robot maps, receives what others publish, finds where
/// they are, and holds the map of all. Robots that hold the same newest tiles and edges have the same team
/// map, to the byte.
///
/// It has no clock and no thread. A comparison of two maps takes seconds: it is handed out as a job. Fusing
/// is cut into slices.
class Team {
 public:
  /// `epoch` numbers this beginning of the robot: it is higher than all earlier ones.
  Team(const TeamConfig& config, peers::Epoch epoch);
  Team(Team&&) = delete;
  Team& operator=(Team&&) = delete;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() = default;

  /// The robot's own map begins anew, in a new odom frame. All that it has published is void, its
  /// deployment too. `epoch` is higher than the last.
  void begin(peers::Epoch epoch);
  /// Where the robot is. Peers are told, and the team's map is brought up to date there first. The path
  /// from one place to the next is what odometry may drift along.
  void be_at(const UncertainPose& T_odom_base);
  /// Where the robot is and people are around it, in its odom frame at `seen`. Peers are told at once.
  void show(peers::Bodies bodies, Time seen) { exchange_.set_bodies(std::move(bodies), seen); }
  /// See bodies_of_peers().
  [[nodiscard]] std::vector<PeerBodies> peer_bodies(Time now) const {
    return bodies_of_peers(exchange_, poses_.T_team_odom, now);
  }
  /// A tile of the robot's own map has changed. It is published as a part of the present submap.
  void observe(mapping::TileKey tile, const mapping::TileState& state, Time now) {
    seen_ += own_tiles_.observe(tile, state, now, own_submaps_.current());
  }
  /// The tiles that some scans changed have been observed. `lost`: odometry was, at one of these scans. While the
  /// robot's map is in doubt, nothing of it is published. What was mapped while scans contradicted it never is, and
  /// another submap begins afterwards.
  void judge(bool lost, Time now);
  /// Where the robot's odom frame lies in a frame that the whole team shares, by a survey or by satellites. Maps do not
  /// overrule a `firm` one. Without effect while what a person has said holds.
  void deploy(const UncertainPose& T_site_odom, bool firm);
  /// A person says where the robot's odom frame lies: in that of a teammate, or, with `ref` 0, in the frame that the
  /// whole team shares. Pairs of which this tells something separate, and merge again where the maps confirm it. Error
  /// kNotFound: nothing is known of the teammate.
  Result<void> put(const UncertainPose& T_ref_odom, peers::RobotId ref);
  /// What a person has said is taken back.
  void forget_place();
  /// Where a peer's odom frame lies in this robot's by something else than maps: a survey, a marker that
  /// both saw. It is published until it is claimed otherwise, also after either robot has begun anew. It
  /// must agree with what the maps say. `probability`: that it is right, 0…1.
  void claim(peers::RobotId peer, const UncertainPose& T_own_peer, double probability) {
    surveyed_.set(peer, T_own_peer, probability);
  }
  /// Takes in a peer's datagram. Errors: see peers::Exchange::receive().
  Result<void> receive(std::span<const std::byte> datagram, Time now) { return exchange_.receive(datagram, now); }
  /// Goes on. To be called some ten times a second. Appends the datagrams to be sent.
  void step(Time now, std::vector<peers::Outgoing>& out);

  /// The comparison that is most worth its time now; nothing while none is, or while one is out.
  [[nodiscard]] std::optional<MatchJob> next_match(Time now);
  /// Takes back a job: one that was run, or one that there was no time for.
  void matched(MatchJob job, Time now);

  /// Goes on with the team's map. True: it is up to date.
  bool fuse(Budget& budget) { return map_.fuse(budget); }

  /// Why nothing of the robot's own map is published now.
  [[nodiscard]] peers::Doubt doubt() const { return check_.doubt(); }
  /// What was not published because of doubts.
  struct HeldBack {
    std::uint64_t times = 0;  ///< that nothing was published for a while
    Duration time{};          ///< all together
    std::uint64_t tiles = 0;  ///< that were never published as they were then
  };
  [[nodiscard]] const HeldBack& held_back() const { return held_back_; }

  /// How many tiles of the robot's own map wait to be published.
  [[nodiscard]] std::size_t unsaid() const { return own_tiles_.waiting(); }
  [[nodiscard]] const merging::TeamMap& map() const { return map_; }
  /// See merging::TeamMap.
  void note_map_changes() { map_.note_changes(); }
  [[nodiscard]] std::vector<mapping::TileKey> take_changed_tiles() { return map_.take_changed_tiles(); }
  [[nodiscard]] const TeamPoses& poses() const { return poses_; }
  /// What all robots claim of where others are.
  [[nodiscard]] std::vector<PairClaim> claims() const { return published_claims(exchange_.layers()); }
  /// Whether the peer's map is a part of the team's map at `now`, and if not, why.
  [[nodiscard]] PeerStanding standing(peers::RobotId peer, Time now) const;
  [[nodiscard]] const peers::Exchange& exchange() const { return exchange_; }

 private:
  void say_deployment(const peers::Deployment& deployment);
  void publish(const IndexedEdge& edge);
  void publish_edges();
  void begin_doubt(Time now);
  void take_news(Time now);
  void take_tile(peers::RobotId robot, peers::ItemId id, Time now);
  void agree();
  void focus();
  [[nodiscard]] peers::Interest interest_of(peers::RobotId peer, peers::RobotId robot) const;
  [[nodiscard]] TeamView view() const;

  TeamConfig config_;
  peers::Exchange exchange_;
  peers::OwnTiles own_tiles_;
  peers::OwnSubmaps own_submaps_;
  peers::SubmapCheck check_;
  peers::SeenAgain seen_;        // since the last judgement
  std::optional<Time> doubted_;  // when it was judged last, if the map was in doubt then
  Time doubt_began_{};
  bool contradicted_ = false;  // in the present doubt
  HeldBack held_back_;
  std::uint32_t firm_ = 0;  // of what was said last of where the robot is
  bool by_person_ = false;  // that was
  SurveyedPoses surveyed_;
  TeamTiles tiles_;
  bool claims_changed_ = true;
  SubmapChains chains_;
  TeamPoses poses_;  // by claims and chains
  ComparedPeers compared_;
  MatchPlan plan_;
  Eigen::Vector3d position_odom_ = Eigen::Vector3d::Zero();  // of this robot, metres
  merging::TeamMap map_;
};

}  // namespace cairn::team
