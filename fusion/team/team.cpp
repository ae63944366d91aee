// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/team.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fusion/peers/items/tile_codec.hpp"

namespace cairn {
namespace {

using peers::RobotId;

constexpr double kLeastVariance = 1e-12;       // m², rad²
constexpr std::size_t kMostOfAKind = 256;      // claims of one robot: each is weighed against the others
constexpr std::uint16_t kKnownEdges = 0x8000;  // those before are found by comparing maps, from 0xC000 by deployment

/// Whether a peer's numbers can be those of a covariance: of nothing that is known to a micrometre, either, which would
/// make the equations of all unsolvable.
bool definite(const Matrix6& covariance) {
  return Matrix6(covariance - kLeastVariance * Matrix6::Identity()).llt().info() == Eigen::Success;
}

bool refined(peers::ItemId edge) {
  return edge.submap() >= Refinements::kFirstEdge && edge.submap() - Refinements::kFirstEdge < Refinements::kMost;
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
      own_submaps_(config.own_submaps, kTileEdge * config.resolution_m),
      map_(config.resolution_m, config.policy) {
  exchange_.set_interest([this](RobotId peer, RobotId robot) { return interest_of(peer, robot); });
  if (config.deployment) exchange_.say(peers::ItemId::deployment(), encode(peers::Deployment{*config.deployment}));
}

void Team::begin(peers::Epoch epoch) {
  own_tiles_.clear();
  own_submaps_.clear();
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
      tiles_.erase(robot);
      map_.drop(robot);
      edges_changed_ = true;
    }
    for (const peers::ItemId id : change.items) {
      if (id.kind() == peers::ItemKind::kTile) take_tile(robot, id, now);
      edges_changed_ = edges_changed_ || id.kind() != peers::ItemKind::kTile;
    }
  }
}

/// A tile is in the submap it was said in last.
void Team::take_tile(RobotId robot, peers::ItemId id, Time now) {
  const auto& items = exchange_.layers().at(robot).holding.items();
  const auto item = items.find(id);
  const std::uint16_t submap = item->first.submap();
  const auto state = peers::decode_tile(item->second.payload);  // checked when it was received
  if (!state) return;
  ++tile_news_[robot];
  if (const auto before = tiles_[robot].put(id.tile(), submap, state->any_occupied()))
    map_.put({robot, *before}, id.tile(), TileState{}, now);
  map_.put({robot, submap}, id.tile(), *state, now);
}

std::size_t Team::walls_of(RobotId robot) const {
  const auto found = tiles_.find(robot);
  return found == tiles_.end() ? 0 : found->second.walls();
}

std::vector<PairClaim> Team::claims() const {
  std::vector<PairClaim> claims;
  const auto& layers = exchange_.layers();
  for (const auto& [robot, layer] : layers) {
    const auto& items = layer.holding.items();
    const auto end = items.lower_bound(peers::ItemId::deployment());
    std::array<std::size_t, 4> taken{};  // found, refined, known, deployed: see the indices of edges
    for (auto item = items.lower_bound(peers::ItemId::edge(0)); item != end; ++item) {
      if (++taken.at(item->first.submap() >> 14U) > kMostOfAKind) continue;
      const auto edge = peers::decode_edge(item->second.payload);
      if (!edge || edge->probability == 0 || !definite(edge->T_own_other.covariance)) continue;  // 0: withdrawn
      const auto other = layers.find(edge->other);
      if (other == layers.end() || other->second.epoch != edge->other_epoch || edge->other == robot) continue;
      claims.push_back({robot, edge->other, edge->T_own_other, static_cast<double>(edge->probability), edge->own_submap,
                        edge->other_submap, refined(item->first)});
    }
  }
  return claims;
}

/// As far as they are known without a gap.
SubmapChains Team::chains() const {
  SubmapChains chains;
  for (const auto& [robot, layer] : exchange_.layers()) {
    const auto& items = layer.holding.items();
    for (std::uint16_t k = 1; k < peers::OwnSubmaps::kMost; ++k) {
      const auto item = items.find(peers::ItemId::submap(k));
      if (item == items.end()) break;
      const auto submap = peers::decode_submap(item->second.payload);
      if (!submap || !definite(submap->T_odom_submap.covariance)) break;
      chains[robot].push_back(submap->T_odom_submap);
    }
  }
  return chains;
}

bool Team::known_submap(RobotId robot, std::uint16_t submap) const {
  const auto chain = chains_.find(robot);
  return submap == 0 || (chain != chains_.end() && submap <= chain->second.size());
}

void Team::agree() {
  if (!std::exchange(edges_changed_, false)) return;
  chains_ = chains();
  poses_ = team_poses(config_.id, claims(), chains_);
  map_.place(poses_.submaps);
}

void Team::focus() {
  const auto own = poses_.T_team_odom.find(config_.id);
  if (own != poses_.T_team_odom.end()) map_.set_focus(own->second * position_odom_);
}

void Team::be_at(const UncertainPose& T_odom_base) {
  position_odom_ = T_odom_base.mean.translation();
  const Eigen::Vector3d& at = position_odom_;
  const Eigen::Vector3d x_axis = T_odom_base.mean.rotation().col(0);
  constexpr double kMost = 1e6;  // others refuse more, and whoever says it
  if (!at.allFinite() || at.cwiseAbs().maxCoeff() > kMost) return;
  own_submaps_.be_at(position_odom_, exchange_);
  const Vector6 sigma = T_odom_base.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  exchange_.set_place({{at.x(), at.y(), at.z()},
                       std::atan2(x_axis.y(), x_axis.x()),
                       std::fmin(kMost, sigma.head<3>().maxCoeff()),
                       std::fmin(kMost, sigma.tail<3>().maxCoeff())});
}

/// Where the peer is, in a frame that is known to lie in the team's.
peers::Interest Team::interest_of(RobotId peer, RobotId robot) const {
  peers::Interest interest{{}, config_.resolution_m};
  const auto link = exchange_.links().find(peer);
  const auto of_peer = poses_.T_team_odom.find(peer), of_robot = poses_.T_team_odom.find(robot);
  const bool known = of_peer != poses_.T_team_odom.end() && of_robot != poses_.T_team_odom.end();
  if (!known || link == exchange_.links().end() || !link->second.place) return interest;
  const Eigen::Vector3d at(link->second.place->position_m.data());
  interest.position_odom = of_robot->second.inverse() * (of_peer->second * at);
  return interest;
}

}  // namespace cairn
