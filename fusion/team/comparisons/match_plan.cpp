// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_plan.hpp"

#include <algorithm>
#include <utility>

#include "fusion/team/comparisons/deployments.hpp"
#include "fusion/team/comparisons/match_outlook.hpp"

namespace cairn::team {
namespace {

using peers::RobotId;

/// A comparison of whole maps that is worth its time.
struct Candidate {
  RobotId id = 0;
  ComparedPeer* peer = nullptr;
  MatchOutlook outlook{};
  double worth = 0;

  /// Of two that are worth the same, the pair that was compared longer ago is better.
  [[nodiscard]] bool better_than(const Candidate& other) const {
    if (peer == nullptr || worth == 0 || worth < other.worth) return false;
    return worth > other.worth || peer->worth.last() < other.peer->worth.last();
  }
};

const peers::Holding& holding_of(const TeamView& team, RobotId robot) {
  return team.exchange.layers().at(robot).holding;
}

/// All that the robot has published, freed of its drift as far as the team knows it.
PublishedTiles whole_map(const TeamView& team, RobotId robot) {
  PublishedTiles tiles = PublishedTiles::of(holding_of(team, robot), team.resolution_m);
  tiles.T_map_odom = team.poses.drifts_of(robot);
  return tiles;
}

/// One submap in its own frame.
PublishedTiles submap_of(const TeamView& team, RobotId robot, std::uint16_t submap) {
  PublishedTiles tiles = PublishedTiles::of(holding_of(team, robot), team.resolution_m, submap);
  tiles.T_map_odom[submap] = place_in_odom(team.chains, robot, submap).inverse();
  return tiles;
}

}  // namespace

std::optional<MatchJob> MatchPlan::next(const TeamView& team, ComparedPeers& compared, Time now) {
  if (out_) return std::nullopt;
  auto job = of_whole_maps(team, compared, now);
  if (!job) job = of_submaps(team, compared, now);
  out_ = job.has_value();
  return job;
}

std::optional<MatchJob> MatchPlan::of_whole_maps(const TeamView& team, ComparedPeers& compared, Time now) const {
  Candidate best;
  for (const auto& [id, layer] : team.exchange.layers()) {
    if (id <= team.self()) continue;  // the lower of two robots compares
    Candidate next{.id = id, .peer = &compared.at(id, team.exchange.epoch(), layer.epoch)};
    const std::size_t tiles = std::min(team.tiles.walls_of(team.self()), team.tiles.walls_of(id));
    if (!next.peer->match || next.peer->worth.rests(now) || tiles < least_tiles_) continue;
    next.outlook = outlook_of(team, id, next.peer->match->hypotheses());
    next.worth = next.peer->worth.of(next.outlook, now);
    if (next.better_than(best)) best = next;
  }
  if (best.peer == nullptr) return std::nullopt;
  best.peer->worth.begin(best.outlook, now);
  return MatchJob{.peer = best.id,
                  .own_epoch = best.peer->own_epoch,
                  .peer_epoch = best.peer->peer_epoch,
                  .firm = best.peer->firm,
                  .own = whole_map(team, team.self()),
                  .other = whole_map(team, best.id),
                  .match = std::move(best.peer->match),
                  .guess = deployed_between(team.exchange.layers(), team.self(), best.id)};
}

std::optional<MatchJob> MatchPlan::of_submaps(const TeamView& team, ComparedPeers& compared, Time now) const {
  for (auto& [id, peer] : compared.all()) {
    if (!team.poses.T_team_odom.contains(id)) continue;
    if (peer.refined != Time::min() && now < peer.refined + config_.period) continue;
    peer.refined = now;
    const RobotTiles &own = team.tiles.of(team.self()), &other = team.tiles.of(id);
    const auto submaps = compared.refinements().next(team.self(), id, own, other, team.poses, team.tile_m());
    if (!submaps) continue;
    const auto guess = team.poses.between({team.self(), submaps->own}, {id, submaps->other});
    if (!guess) continue;
    return MatchJob{.peer = id,
                    .own_epoch = peer.own_epoch,
                    .peer_epoch = peer.peer_epoch,
                    .firm = peer.firm,
                    .own = submap_of(team, team.self(), submaps->own),
                    .other = submap_of(team, id, submaps->other),
                    .refinement = Refinement{.submaps = *submaps, .guess = *guess}};
  }
  return std::nullopt;
}

}  // namespace cairn::team
