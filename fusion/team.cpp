// SPDX-License-Identifier: Apache-2.0
#include "fusion/team.hpp"

#include <algorithm>
#include <utility>

#include "fusion/peers/tile_codec.hpp"

namespace cairn {
namespace {

using peers::RobotId;

constexpr double kMovedM = 0.02, kTurnedRad = 0.003;  // an edge that is said again

bool moved(const SE3& from, const SE3& to) {
  const SE3 change = from.inverse() * to;
  return change.translation().norm() > kMovedM || rotation_angle(change) > kTurnedRad;
}

}  // namespace

Team::Team(const TeamConfig& config, peers::Epoch epoch)
    : config_(config),
      exchange_(config.id, config.name, epoch, config.exchange),
      own_tiles_(config.own_tiles),
      map_(config.resolution_m, config.policy) {}

void Team::step(Time now, std::vector<peers::Outgoing>& out) {
  own_tiles_.say(exchange_, now);  // what this robot sees
  take_news(now);                  // what everyone has said
  agree();                         // where everyone is
  exchange_.send(now, out);        // what others miss
}

void Team::take_news(Time now) {
  for (const auto& [robot, change] : exchange_.take_changes()) {
    if (change.anew) {
      mapped_.erase(robot);
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
  map_.put({robot, id.submap()}, id.tile(), *state, now);
  if (id.submap() != 0) return;  // it has a frame of its own
  Mapped& mapped = mapped_[robot];
  if (!mapped.tree) mapped.tree = std::make_shared<SemanticOcTree>(config_.resolution_m);
  if (mapped.tree.use_count() > 1) mapped.tree = std::make_shared<SemanticOcTree>(*mapped.tree);  // a job reads it
  mapped.occupied_tiles += state->any_occupied() ? 1 : 0;
  mapped.occupied_tiles -= read_tile(*mapped.tree, id.tile()).any_occupied() ? 1 : 0;
  write_tile(*mapped.tree, id.tile(), *state);
}

std::vector<PairClaim> Team::claims() const {
  std::vector<PairClaim> claims;
  const auto& layers = exchange_.layers();
  for (const auto& [robot, layer] : layers) {
    const auto& items = layer.holding.items();
    for (auto item = items.lower_bound(peers::ItemId::edge(0)); item != items.end(); ++item) {
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
    pair.edge = edge;
  }
  return pair;
}

bool Team::worth_comparing(RobotId peer, const Pair& pair, Time now) const {
  const auto own = mapped_.find(config_.id), other = mapped_.find(peer);
  if (!pair.match || own == mapped_.end() || other == mapped_.end()) return false;
  const auto grown = [&](const Mapped& mapped, std::size_t then) {
    return static_cast<double>(mapped.occupied_tiles) >= config_.match_growth * static_cast<double>(then);
  };
  return std::min(own->second.occupied_tiles, other->second.occupied_tiles) >= config_.least_tiles &&
         (pair.last == Time::min() || now >= pair.last + config_.match_period) &&
         (grown(own->second, pair.own_tiles) || grown(other->second, pair.peer_tiles));
}

std::optional<MatchJob> Team::next_match(Time now) {
  if (match_out_) return std::nullopt;
  Pair* next = nullptr;
  RobotId with = 0;
  for (const auto& [peer, layer] : exchange_.layers()) {
    if (peer <= config_.id) continue;  // the lower of two compares
    Pair& pair = pair_with(peer, layer.epoch);
    if (!worth_comparing(peer, pair, now)) continue;
    if (next == nullptr || pair.last < next->last) {
      next = &pair;
      with = peer;
    }
  }
  if (next == nullptr) return std::nullopt;
  next->last = now;
  next->own_tiles = mapped_.at(config_.id).occupied_tiles;
  next->peer_tiles = mapped_.at(with).occupied_tiles;
  match_out_ = true;
  return MatchJob{with,
                  next->own_epoch,
                  next->peer_epoch,
                  mapped_.at(config_.id).tree,
                  mapped_.at(with).tree,
                  std::move(next->match)};
}

void run(MatchJob& job, Budget& budget) {
  const auto own = matching::MapFeatures::build(*job.own), other = matching::MapFeatures::build(*job.other);
  if (own && other) job.match->update(*own, *other, budget);
}

void Team::matched(MatchJob job) {
  match_out_ = false;
  const auto pair = pairs_.find(job.peer);
  if (pair == pairs_.end() || pair->second.own_epoch != job.own_epoch || pair->second.peer_epoch != job.peer_epoch)
    return;
  pair->second.match = std::move(job.match);
  say_edge(job.peer, pair->second);
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

PeerStanding Team::standing(RobotId peer, Time now) const {
  if (poses_.T_team_odom.contains(peer)) return {true, "merged"};
  const auto& layers = exchange_.layers();
  const auto link = exchange_.links().find(peer);
  if (link == exchange_.links().end() && !layers.contains(peer)) return {false, "never heard of"};
  if (!layers.contains(peer)) return {false, "it has said nothing of its map yet"};
  const auto mapped = mapped_.find(peer), own = mapped_.find(config_.id);
  const auto tiles = [&](auto it) { return it == mapped_.end() ? std::size_t{0} : it->second.occupied_tiles; };
  if (std::min(tiles(mapped), tiles(own)) < config_.least_tiles)
    return {false, "too little mapped: " + std::to_string(tiles(own)) + " and " + std::to_string(tiles(mapped)) +
                       " tiles with walls, " + std::to_string(config_.least_tiles) + " needed"};
  if (peer < config_.id) return {false, exchange_.hears(peer, now) ? "it compares the two maps" : "no link"};
  const auto pair = pairs_.find(peer);
  if (pair == pairs_.end() || !pair->second.match) return {false, "being compared"};
  const auto hypotheses = pair->second.match->hypotheses().all();
  if (hypotheses.empty()) return {false, "no place found where the maps overlap"};
  return {false, hypotheses.front().reason};
}

}  // namespace cairn
