// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/team.hpp"

#include <cmath>
#include <utility>

#include "fusion/peers/items/tile_codec.hpp"
#include "fusion/peers/own_place.hpp"
#include "fusion/team/comparisons/deployments.hpp"
#include "fusion/team/comparisons/match_results.hpp"

namespace cairn::team {

using peers::RobotId;

namespace {

// Contradictions show within some batches.
constexpr Duration kNoticedIn = std::chrono::seconds(3);

constexpr double kAnywhere = 1e8;  // m², rad²: nothing is known

peers::ExchangeConfig with_voxels(peers::ExchangeConfig config, double resolution_m) {
  config.voxel_um = static_cast<std::uint32_t>(std::lround(1e6 * resolution_m));
  return config;
}

}  // namespace

Team::Team(const TeamConfig& config, peers::Epoch epoch)
    : config_(config),
      exchange_(config.id, config.name, epoch, with_voxels(config.exchange, config.resolution_m)),
      own_tiles_(config.own_tiles),
      own_submaps_(config.own_submaps, mapping::kTileEdge * config.resolution_m),
      compared_(config.match),
      plan_(config.match, config.least_tiles),
      map_(config.resolution_m, config.policy) {
  exchange_.set_interest([this](RobotId peer, RobotId robot) { return interest_of(peer, robot); });
  if (config.deployment) deploy(*config.deployment, false);
}

void Team::deploy(const UncertainPose& T_site_odom, bool firm) {
  if (by_person_) return;
  if (firm && firm_ == 0) firm_ = 1;
  say_deployment({.T_ref_odom = T_site_odom, .firm = firm_});
}

Result<void> Team::put(const UncertainPose& T_ref_odom, RobotId ref) {
  const auto layer = exchange_.layers().find(ref);
  if (ref != 0 && layer == exchange_.layers().end()) return Error{Errc::kNotFound, "nothing is known of this teammate"};
  const peers::Epoch epoch = ref == 0 ? 0 : layer->second.epoch;
  by_person_ = true;
  say_deployment({.T_ref_odom = T_ref_odom, .ref = ref, .ref_epoch = epoch, .firm = ++firm_});
  return {};
}

void Team::forget_place() {
  if (!std::exchange(by_person_, false)) return;
  say_deployment({.T_ref_odom = {SE3(), kAnywhere * Matrix6::Identity()}, .firm = ++firm_});
}

void Team::say_deployment(const peers::Deployment& deployment) {
  exchange_.say(peers::ItemId::deployment(), encode(deployment));
}

void Team::begin(peers::Epoch epoch) {
  own_tiles_.clear();
  own_submaps_.clear();
  check_ = {};
  seen_ = {};
  doubted_.reset();
  firm_ = 0;
  by_person_ = false;
  exchange_.begin(epoch);
}

void Team::be_at(const UncertainPose& T_odom_base) {
  position_odom_ = T_odom_base.mean.translation();
  const auto place = peers::place_of(T_odom_base);
  if (!place) return;  // no peer would take it
  own_submaps_.be_at(T_odom_base, exchange_);
  exchange_.set_place(*place);
}

void Team::judge(bool lost, Time now) {
  check_.judge(lost, std::exchange(seen_, {}));
  const peers::Doubt doubt = check_.doubt();
  if (doubted_) held_back_.time += now - *doubted_;
  if (doubt != peers::Doubt::kNone) {
    if (!doubted_) begin_doubt(now);
    contradicted_ = contradicted_ || doubt == peers::Doubt::kContradicted;
    doubted_ = now;
  } else if (std::exchange(doubted_, std::nullopt) && contradicted_) {
    held_back_.tiles += own_tiles_.forget(doubt_began_);
    own_submaps_.cut(exchange_);
  }
}

/// What was mapped in the moments before it was noticed is in doubt as well.
void Team::begin_doubt(Time now) {
  doubt_began_ = now - kNoticedIn;
  contradicted_ = false;
  ++held_back_.times;
}

void Team::step(Time now, std::vector<peers::Outgoing>& out) {
  if (check_.doubt() == peers::Doubt::kNone) own_tiles_.say(exchange_, now);
  publish_edges();
  take_news(now);
  agree();
  focus();
  exchange_.send(now, out);
}

std::optional<MatchJob> Team::next_match(Time now) { return plan_.next(view(), compared_, now); }

void Team::matched(MatchJob job, Time now) {
  plan_.done();
  if (const auto edge = take_result(std::move(job), view(), compared_, now)) publish(*edge);
}

PeerStanding Team::standing(RobotId peer, Time now) const {
  return standing_of(peer, view(), compared_, config_.least_tiles, now);
}

void Team::publish(const IndexedEdge& edge) { exchange_.say(peers::ItemId::edge(edge.index), encode(edge.edge)); }

/// Those that owe nothing to comparisons.
void Team::publish_edges() {
  for (const IndexedEdge& edge : surveyed_.edges(exchange_.layers())) publish(edge);
  for (const IndexedEdge& edge : heed_firm(view(), compared_)) publish(edge);
  for (const IndexedEdge& edge : deployment_edges(view(), compared_)) publish(edge);
}

/// What all robots have published since the last step, this one too.
void Team::take_news(Time now) {
  for (const auto& [robot, change] : exchange_.take_changes()) {
    if (change.anew) {
      tiles_.forget(robot);
      map_.drop(robot);
      claims_changed_ = true;
    }
    for (const peers::ItemId id : change.items) {
      if (id.kind() == peers::ItemKind::kTile)
        take_tile(robot, id, now);
      else
        claims_changed_ = true;
    }
  }
}

void Team::take_tile(RobotId robot, peers::ItemId id, Time now) {
  const auto& items = exchange_.layers().at(robot).holding.items();
  const auto& [held, item] = *items.find(id);  // its submap may be a newer one than the id's
  const auto state = peers::decode_tile(item.payload);
  if (!state) return;
  if (const auto before = tiles_.put(robot, id.tile(), held.submap(), state->any_occupied()))
    map_.put({robot, *before}, id.tile(), mapping::TileState{}, now);
  map_.put({robot, held.submap()}, id.tile(), *state, now);
}

/// Where all robots are.
void Team::agree() {
  if (!std::exchange(claims_changed_, false)) return;
  chains_ = published_chains(exchange_.layers());
  poses_ = team_poses(config_.id, claims(), chains_);
  map_.place(poses_.submaps);
}

/// The map is fused near this robot first.
void Team::focus() {
  const auto own = poses_.T_team_odom.find(config_.id);
  if (own != poses_.T_team_odom.end()) map_.set_focus(own->second * position_odom_);
}

/// The peer's place in the robot's odom frame, if both are in the team: tiles near it are sent first.
peers::Interest Team::interest_of(RobotId peer, RobotId robot) const {
  peers::Interest interest{.position_odom = {}, .resolution_m = config_.resolution_m};
  const auto link = exchange_.links().find(peer);
  const auto of_peer = poses_.T_team_odom.find(peer), of_robot = poses_.T_team_odom.find(robot);
  const bool known = of_peer != poses_.T_team_odom.end() && of_robot != poses_.T_team_odom.end();
  if (!known || link == exchange_.links().end() || !link->second.place) return interest;
  const Eigen::Vector3d at(link->second.place->position_m.data());
  interest.position_odom = of_robot->second.inverse() * (of_peer->second * at);
  return interest;
}

TeamView Team::view() const {
  return {
      .exchange = exchange_, .tiles = tiles_, .poses = poses_, .chains = chains_, .resolution_m = config_.resolution_m};
}

}  // namespace cairn::team
