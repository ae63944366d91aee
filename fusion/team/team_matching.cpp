// SPDX-License-Identifier: Apache-2.0
// A team's comparisons of maps: which is worth its time, and what is said of what came of it.
#include <algorithm>
#include <utility>

#include "fusion/team/team.hpp"

namespace cairn {
namespace {

using peers::RobotId;

constexpr double kMovedM = 0.02, kTurnedRad = 0.003;  // an edge that is said again

bool moved(const SE3& from, const SE3& to) {
  const SE3 change = from.inverse() * to;
  return change.translation().norm() > kMovedM || rotation_angle(change) > kTurnedRad;
}

bool same_submaps(const peers::Edge& x, const peers::Edge& y) {
  return x.own_submap == y.own_submap && x.other_submap == y.other_submap;
}

}  // namespace

/// Where odom lies in a map of a robot's submaps that begins with the first of them, by what the team knows of its
/// drift.
std::map<std::uint16_t, SE3> Team::undrifted(RobotId robot) const {
  std::map<std::uint16_t, SE3> T_map_odom;
  const auto first = poses_.submaps.find({robot, 0});
  if (first == poses_.submaps.end()) return T_map_odom;
  for (auto submap = std::next(first); submap != poses_.submaps.end() && submap->first.robot == robot; ++submap)
    if (submap->second.matrix() != first->second.matrix())
      T_map_odom[submap->first.submap] = first->second.inverse() * submap->second;
  return T_map_odom;
}

/// All of it, or one submap in its own frame.
SaidTiles Team::said_by(RobotId robot, std::optional<std::uint16_t> submap) const {
  SaidTiles said{config_.resolution_m, {}, {}, {}};
  for (const auto& [id, item] : exchange_.layers().at(robot).holding.items()) {
    if (id.kind() != peers::ItemKind::kTile || id.submap() != submap.value_or(id.submap())) continue;
    said.tiles.push_back({id.tile(), id.submap(), said.payloads.size(), item.payload.size()});
    said.payloads.insert(said.payloads.end(), item.payload.begin(), item.payload.end());
  }
  if (!submap)
    said.T_map_odom = undrifted(robot);
  else
    said.T_map_odom[*submap] = place_in_odom(chains_, robot, *submap).inverse();
  return said;
}

/// What is known about a pair is void when one of the two has begun anew.
Team::Pair& Team::pair_with(RobotId peer, peers::Epoch epoch) {
  const auto [entry, added] = pairs_.try_emplace(peer);
  Pair& pair = entry->second;
  if (added) pair.edge = static_cast<std::uint16_t>(pairs_.size() - 1);
  if (pair.own_epoch != exchange_.epoch() || pair.peer_epoch != epoch) {
    if (pair.own_epoch != exchange_.epoch()) refinements_.clear();
    refinements_.forget(peer);
    const std::uint16_t edge = pair.edge;
    pair = Pair{};
    pair.own_epoch = exchange_.epoch();
    pair.peer_epoch = epoch;
    pair.match = std::make_unique<matching::GrowingMatch>();
    pair.worth = MatchWorth(config_.match);
    pair.edge = edge;
  }
  return pair;
}

std::optional<MatchJob> Team::next_match(Time now) {
  if (match_out_) return std::nullopt;
  Pair* next = nullptr;
  RobotId with = 0;
  MatchOutlook then;
  double most = 0;
  for (const auto& [peer, layer] : exchange_.layers()) {
    if (peer <= config_.id) continue;  // the lower of two compares
    Pair& pair = pair_with(peer, layer.epoch);
    if (!pair.match || pair.worth.rests(now) || std::min(walls_of(config_.id), walls_of(peer)) < config_.least_tiles)
      continue;
    const MatchOutlook now_known = outlook(peer, pair);
    const double worth = pair.worth.of(now_known, now);
    if (worth == 0 || worth < most || (worth == most && pair.worth.last() >= next->worth.last())) continue;
    next = &pair;
    with = peer;
    then = now_known;
    most = worth;
  }
  if (next == nullptr) return next_refinement(now);
  next->worth.begin(then, now);
  match_out_ = true;
  return MatchJob{with,          next->own_epoch,        next->peer_epoch, said_by(config_.id),
                  said_by(with), std::move(next->match), deployed(with),   {}};
}

/// Submaps of those whose maps are found to belong together.
std::optional<MatchJob> Team::next_refinement(Time now) {
  for (auto& [peer, pair] : pairs_) {
    if (!poses_.T_team_odom.contains(peer)) continue;
    if (pair.refined != Time::min() && now < pair.refined + config_.match.period) continue;
    pair.refined = now;
    const auto submaps = refinements_.next(config_.id, peer, tiles_[config_.id], tiles_[peer], poses_, tile_m());
    if (!submaps) continue;
    const auto guess = poses_.between({config_.id, submaps->own}, {peer, submaps->other});
    if (!guess) continue;
    match_out_ = true;
    return MatchJob{peer,
                    pair.own_epoch,
                    pair.peer_epoch,
                    said_by(config_.id, submaps->own),
                    said_by(peer, submaps->other),
                    nullptr,
                    {},
                    Refinement{*submaps, *guess, {}, 0}};
  }
  return std::nullopt;
}

void Team::matched(MatchJob job, Time now) {
  match_out_ = false;
  const auto found = pairs_.find(job.peer);
  if (found == pairs_.end() || found->second.own_epoch != job.own_epoch || found->second.peer_epoch != job.peer_epoch ||
      job.own_epoch != exchange_.epoch())
    return;
  Pair& pair = found->second;
  if (job.refinement) return say_refined(*job.refinement, job.peer_epoch);
  pair.match = std::move(job.match);
  if (!job.ran) return;
  const PlaceStanding before = std::exchange(pair.standing, PlaceStanding::of(*pair.match));
  pair.worth.end(pair.standing != before, now);
  weigh_deployment(job.peer, pair);
  say_edge(job, pair);
}

/// Where a whole map lies in another, as a claim about the two submaps that have most in common there.
peers::Edge Team::edge_of(const MatchJob& job, const UncertainPose& T_own_other) const {
  peers::Edge edge{0, job.peer, job.peer_epoch, 0, T_own_other, 0};
  std::size_t most = 0;
  SE3 T_own_odom, T_other_odom;  // in the maps that were compared
  for (const auto& [own, own_walls] : tiles_.at(config_.id).walls_by_submap())
    for (const auto& [other, other_walls] : tiles_.at(job.peer).walls_by_submap()) {
      const SE3 T_own = job.own.T_map_odom_of(own), T_other = job.other.T_map_odom_of(other);
      const SE3 T_other_own = (T_own.inverse() * T_own_other.mean * T_other).inverse();
      const std::size_t common = common_tiles(own_walls, other_walls, T_other_own, tile_m());
      if (common <= most || !known_submap(config_.id, own) || !known_submap(job.peer, other)) continue;
      most = common;
      edge.own_submap = own;
      edge.other_submap = other;
      T_own_odom = T_own;
      T_other_odom = T_other;
    }
  if (edge.own_submap == 0 && edge.other_submap == 0) return edge;
  const SE3 T_own_submap = T_own_odom * place_in_odom(chains_, config_.id, edge.own_submap);
  const SE3 T_other_submap = T_other_odom * place_in_odom(chains_, job.peer, edge.other_submap);
  const Matrix6 adjoint = T_other_submap.inverse().adjoint();
  edge.T_own_other = {T_own_submap.inverse() * T_own_other.mean * T_other_submap,
                      adjoint * T_own_other.covariance * adjoint.transpose()};
  return edge;
}

/// Says where the peer is once that is sure, and when it is known better; takes it back when it is not sure any more.
void Team::say_edge(const MatchJob& job, Pair& pair) {
  const matching::Hypothesis* accepted = pair.match->hypotheses().accepted();
  const bool said = pair.said && pair.said->probability > 0;
  if (accepted == nullptr && !said) return;
  peers::Edge edge;
  if (accepted != nullptr) {
    edge = edge_of(job, accepted->T_a_b);
    if (said && same_submaps(*pair.said, edge) && !moved(pair.said->T_own_other.mean, edge.T_own_other.mean)) return;
    edge.probability = static_cast<float>(accepted->probability_correct);
  } else {
    edge = *pair.said;
    edge.probability = 0;
  }
  pair.said = edge;
  exchange_.say(peers::ItemId::edge(pair.edge), encode(edge));
}

void Team::say_refined(const Refinement& refinement, peers::Epoch peer_epoch) {
  if (!refinement.found) return;
  const SubmapPair& submaps = refinement.submaps;
  auto& said = refinements_.said(submaps);
  if (said && !moved(said->T_own_other.mean, refinement.found->mean)) return;
  said = peers::Edge{submaps.own,   submaps.peer,      peer_epoch,
                     submaps.other, *refinement.found, static_cast<float>(refinement.probability)};
  exchange_.say(peers::ItemId::edge(refinements_.edge_of(submaps)), encode(*said));
}

}  // namespace cairn
