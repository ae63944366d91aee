// SPDX-License-Identifier: Apache-2.0
#include "fusion/team.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fusion/peers/tile_codec.hpp"

namespace cairn {
namespace {

using peers::RobotId;

constexpr double kMovedM = 0.02, kTurnedRad = 0.003;  // an edge that is said again

constexpr std::uint16_t kKnownEdges = 0x8000;  // those before are found by comparing maps, from 0xC000 by deployment

bool moved(const SE3& from, const SE3& to) {
  const SE3 change = from.inverse() * to;
  return change.translation().norm() > kMovedM || rotation_angle(change) > kTurnedRad;
}

/// What is made of the likeliest place: that it changes is what comparisons are for.
std::string standing_of(const matching::GrowingMatch& match) {
  const auto places = match.hypotheses().all();
  if (places.empty()) return {};
  return std::to_string(static_cast<int>(places.front().standing)) + " " + std::to_string(places.front().agreements);
}

peers::ExchangeConfig with_voxels(peers::ExchangeConfig config, double resolution_m) {
  config.voxel_um = static_cast<std::uint32_t>(std::lround(1e6 * resolution_m));
  return config;
}

}  // namespace

Team::Team(const TeamConfig& config, peers::Epoch epoch)
    : config_(config),
      exchange_(config.id, config.name, epoch, with_voxels(config.exchange, config.resolution_m)),
      own_tiles_(config.own_tiles),
      map_(config.resolution_m, config.policy) {
  exchange_.set_interest([this](RobotId peer, RobotId robot) { return interest_of(peer, robot); });
  if (config.deployment) exchange_.say(peers::ItemId::deployment(), encode(peers::Deployment{*config.deployment}));
}

void Team::begin(peers::Epoch epoch) {
  own_tiles_.clear();
  exchange_.begin(epoch);
}

void Team::step(Time now, std::vector<peers::Outgoing>& out) {
  own_tiles_.say(exchange_, now);  // what this robot sees
  say_known_poses();
  say_deployments();
  take_news(now);            // what everyone has said
  agree();                   // where everyone is
  focus();                   // what is wanted first
  exchange_.send(now, out);  // what others miss
}

void Team::say_known_poses() {
  std::uint16_t edge = kKnownEdges;
  for (const auto& [peer, known] : known_poses_) {
    const auto layer = exchange_.layers().find(peer);
    if (layer != exchange_.layers().end())
      exchange_.say(peers::ItemId::edge(edge),
                    encode(peers::Edge{0, peer, layer->second.epoch, 0, known.first, known.second}));
    ++edge;
  }
}

void Team::take_news(Time now) {
  for (const auto& [robot, change] : exchange_.take_changes()) {
    if (change.anew) {
      walls_.erase(robot);
      map_.drop(robot);
      edges_changed_ = true;
    }
    for (const peers::ItemId id : change.items) {
      if (id.kind() == peers::ItemKind::kTile) take_tile(robot, id, now);
      edges_changed_ = edges_changed_ || id.kind() != peers::ItemKind::kTile;
    }
  }
}

void Team::take_tile(RobotId robot, peers::ItemId id, Time now) {
  const auto& items = exchange_.layers().at(robot).holding.items();
  const auto state = peers::decode_tile(items.at(id).payload);  // checked when it was received
  if (!state) return;
  ++tile_news_[robot];
  map_.put({robot, id.submap()}, id.tile(), *state, now);
  if (id.submap() != 0) return;  // it has a frame of its own
  if (state->any_occupied())
    walls_[robot].insert(id.tile());
  else
    walls_[robot].erase(id.tile());
}

std::size_t Team::walls_of(RobotId robot) const {
  const auto found = walls_.find(robot);
  return found == walls_.end() ? 0 : found->second.size();
}

/// Of its first submap: others have frames of their own.
SaidTiles Team::said_by(RobotId robot) const {
  SaidTiles said{config_.resolution_m, {}, {}};
  for (const auto& [id, item] : exchange_.layers().at(robot).holding.items()) {
    if (id.kind() != peers::ItemKind::kTile || id.submap() != 0) continue;
    said.tiles.push_back({id.tile(), said.payloads.size(), item.payload.size()});
    said.payloads.insert(said.payloads.end(), item.payload.begin(), item.payload.end());
  }
  return said;
}

SemanticOcTree SaidTiles::map() const {
  SemanticOcTree map(resolution_m);
  for (const Tile& tile : tiles)
    if (const auto state = peers::decode_tile(std::span(payloads).subspan(tile.begin, tile.bytes)))
      write_tile(map, tile.key, *state);
  return map;
}

std::vector<PairClaim> Team::claims() const {
  std::vector<PairClaim> claims;
  const auto& layers = exchange_.layers();
  for (const auto& [robot, layer] : layers) {
    const auto& items = layer.holding.items();
    const auto end = items.lower_bound(peers::ItemId::deployment());
    for (auto item = items.lower_bound(peers::ItemId::edge(0)); item != end; ++item) {
      const auto edge = peers::decode_edge(item->second.payload);
      if (!edge || edge->probability == 0) continue;  // withdrawn
      const auto other = layers.find(edge->other);
      if (other == layers.end() || other->second.epoch != edge->other_epoch || edge->other == robot) continue;
      claims.push_back({robot, edge->other, edge->T_own_other, static_cast<double>(edge->probability)});
    }
  }
  return claims;
}

void Team::agree() {
  if (!std::exchange(edges_changed_, false)) return;
  poses_ = team_poses(config_.id, claims());
  merging::SubmapPoses submaps;
  for (const auto& [robot, T_team_odom] : poses_.T_team_odom)
    submaps.emplace(merging::SubmapKey{robot, 0}, T_team_odom);
  map_.place(submaps);
}

void Team::focus() {
  const auto own = poses_.T_team_odom.find(config_.id);
  if (own != poses_.T_team_odom.end()) map_.set_focus(own->second * position_odom_);
}

void Team::be_at(const UncertainPose& T_odom_base) {
  position_odom_ = T_odom_base.mean.translation();
  const Eigen::Vector3f at = position_odom_.cast<float>();
  const Eigen::Vector3d x_axis = T_odom_base.mean.rotation().col(0);
  constexpr double kMost = 1e6;  // others refuse more, and whoever says it
  if (!at.allFinite() || at.cwiseAbs().maxCoeff() > kMost) return;
  const Vector6 sigma = T_odom_base.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  exchange_.set_place({{at.x(), at.y(), at.z()},
                       static_cast<float>(std::atan2(x_axis.y(), x_axis.x())),
                       static_cast<float>(std::fmin(kMost, sigma.head<3>().maxCoeff())),
                       static_cast<float>(std::fmin(kMost, sigma.tail<3>().maxCoeff()))});
}

/// Where the peer is, in a frame that is known to lie in the team's.
peers::Interest Team::interest_of(RobotId peer, RobotId robot) const {
  peers::Interest interest{{}, config_.resolution_m};
  const auto link = exchange_.links().find(peer);
  const auto of_peer = poses_.T_team_odom.find(peer), of_robot = poses_.T_team_odom.find(robot);
  const bool known = of_peer != poses_.T_team_odom.end() && of_robot != poses_.T_team_odom.end();
  if (!known || link == exchange_.links().end() || !link->second.place) return interest;
  const Eigen::Vector3f at(link->second.place->position_m.data());
  interest.position_odom = of_robot->second.inverse() * (of_peer->second * at.cast<double>());
  return interest;
}

/// What is known about a pair is void when one of the two has begun anew.
Team::Pair& Team::pair_with(RobotId peer, peers::Epoch epoch) {
  const auto [entry, added] = pairs_.try_emplace(peer);
  Pair& pair = entry->second;
  if (added) pair.edge = static_cast<std::uint16_t>(pairs_.size() - 1);
  if (pair.own_epoch != exchange_.epoch() || pair.peer_epoch != epoch) {
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
  if (next == nullptr) return std::nullopt;
  next->worth.begin(then, now);
  match_out_ = true;
  return MatchJob{with,          next->own_epoch,        next->peer_epoch, said_by(config_.id),
                  said_by(with), std::move(next->match), deployed(with)};
}

void run(MatchJob& job, Budget& budget) {
  const SemanticOcTree own_map = job.own.map(), other_map = job.other.map();  // features read them
  const auto own = matching::MapFeatures::build(own_map), other = matching::MapFeatures::build(other_map);
  if (own && other) job.match->update(*own, *other, budget, job.guess);
  job.ran = true;
}

void Team::matched(MatchJob job, Time now) {
  match_out_ = false;
  const auto found = pairs_.find(job.peer);
  if (found == pairs_.end() || found->second.own_epoch != job.own_epoch || found->second.peer_epoch != job.peer_epoch)
    return;
  Pair& pair = found->second;
  pair.match = std::move(job.match);
  if (!job.ran) return;
  const std::string before = std::exchange(pair.standing, standing_of(*pair.match));
  pair.worth.end(pair.standing != before, now);
  weigh_deployment(job.peer, pair);
  say_edge(job.peer, pair);
}

/// Says where the peer is once that is sure, and when it is known better; takes it back when it is not sure any more.
void Team::say_edge(RobotId peer, Pair& pair) {
  const matching::Hypothesis* accepted = pair.match->hypotheses().accepted();
  const bool said = pair.said && pair.said->probability > 0;
  if (accepted == nullptr && !said) return;
  peers::Edge edge{0, peer, pair.peer_epoch, 0, {}, 0};
  if (accepted != nullptr) {
    if (said && !moved(pair.said->T_own_other.mean, accepted->T_a_b.mean)) return;
    edge.T_own_other = accepted->T_a_b;
    edge.probability = static_cast<float>(accepted->probability_correct);
  } else {
    edge.T_own_other = pair.said->T_own_other;
  }
  pair.said = edge;
  exchange_.say(peers::ItemId::edge(pair.edge), encode(edge));
}

}  // namespace cairn
