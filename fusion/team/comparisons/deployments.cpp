// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/deployments.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "fusion/matching/belief/guess.hpp"

namespace cairn::team {
namespace {

using peers::RobotId;

constexpr double kDegree = std::numbers::pi / 180;  // rad
constexpr double kExactYaw_rad = 0.5 * kDegree;     // about what matching finds: a voxel of 0.2 m at 23 m

/// Whether it is as good as what the maps can say.
bool exact(const UncertainPose& T, double voxel_m) {
  const Vector6 sigma = T.covariance.diagonal().cwiseSqrt();
  return sigma.head<3>().maxCoeff() <= voxel_m && sigma[5] <= kExactYaw_rad;
}

std::optional<peers::Deployment> deployment_of(const peers::Layers& layers, RobotId robot) {
  const auto layer = layers.find(robot);
  if (layer == layers.end()) return std::nullopt;
  const auto item = layer->second.holding.items().find(peers::ItemId::deployment());
  if (item == layer->second.holding.items().end()) return std::nullopt;
  const auto deployment = peers::decode_deployment(item->second.payload);
  if (!deployment) return std::nullopt;
  const auto ref = layers.find(deployment->ref);
  const bool holds = deployment->ref == 0 || (ref != layers.end() && ref->second.epoch == deployment->ref_epoch);
  return holds ? std::optional(*deployment) : std::nullopt;
}

/// A robot's odom frame in the frame at the end of its chain of deployments.
struct Anchored {
  RobotId root = 0;  // 0: the frame that all share
  UncertainPose T_root_odom;
};

/// Nothing, if deployments go in a circle.
std::optional<Anchored> anchored(const peers::Layers& layers, RobotId robot) {
  Anchored place{robot, {SE3(), Matrix6::Zero()}};
  for (std::size_t links = 0; links <= layers.size(); ++links) {
    const auto next = deployment_of(layers, place.root);
    if (!next) return place;
    place = {next->ref, compose(next->T_ref_odom, place.T_root_odom)};
    if (place.root == 0) return place;
  }
  return std::nullopt;
}

std::string contradiction(const SE3& T_deployed, const SE3& T_found) {
  const SE3 off = T_deployed.inverse() * T_found;
  char text[120];
  std::snprintf(text, sizeof text, "; the deployments of the two contradict that by %.1f m and %.1f degrees",
                off.translation().norm(), rotation_angle(off) / kDegree);
  return text;
}

}  // namespace

std::optional<UncertainPose> deployed_between(const peers::Layers& layers, RobotId a, RobotId b) {
  if (const auto of_b = deployment_of(layers, b); of_b && of_b->ref == a) return of_b->T_ref_odom;
  if (const auto of_a = deployment_of(layers, a); of_a && of_a->ref == b) return inverse(of_a->T_ref_odom);
  const auto place_a = anchored(layers, a), place_b = anchored(layers, b);
  if (!place_a || !place_b || place_a->root != place_b->root) return std::nullopt;
  return compose(inverse(place_a->T_root_odom), place_b->T_root_odom);
}

std::uint64_t firmness(const peers::Layers& layers, RobotId a, RobotId b) {
  if (!deployed_between(layers, a, b)) return 0;
  const auto of_a = deployment_of(layers, a), of_b = deployment_of(layers, b);
  return std::uint64_t{of_a ? of_a->firm : 0} + (of_b ? of_b->firm : 0);
}

bool refutes(const matching::PendingHypotheses& places, const UncertainPose& T_own_peer) {
  return std::ranges::any_of(places.all(), [&](const matching::Hypothesis& place) {
    const bool dropped = place.standing == matching::Standing::kDropped;
    return matching::agrees(T_own_peer, place.T_a_b.mean) ? dropped : place.agreements > 0;
  });
}

std::vector<IndexedEdge> deployment_edges(const TeamView& team, ComparedPeers& compared) {
  std::vector<IndexedEdge> edges;
  const auto& layers = team.exchange.layers();
  const auto& published = layers.at(team.self()).holding.items();
  for (const auto& [id, layer] : layers) {
    const auto T_own_peer = id > team.self() ? deployed_between(layers, team.self(), id) : std::nullopt;
    if (!T_own_peer) continue;
    const ComparedPeer& peer = compared.at(id, team.exchange.epoch(), layer.epoch);
    const std::uint16_t index = edge_index(EdgeOrigin::kDeployed, peer.edge.index());
    const bool stands = exact(*T_own_peer, team.resolution_m) && !peer.found && !peer.deployment_refuted;
    if (!stands && !published.contains(peers::ItemId::edge(index))) continue;
    const float probability = stands ? static_cast<float>(1 - matching::kWrongGuess) : 0;
    edges.push_back({index,
                     {.own_submap = 0,
                      .other = id,
                      .other_epoch = layer.epoch,
                      .other_submap = 0,
                      .T_own_other = *T_own_peer,
                      .probability = probability}});
  }
  return edges;
}

std::vector<IndexedEdge> heed_firm(const TeamView& team, ComparedPeers& compared) {
  std::vector<IndexedEdge> edges;
  const auto& layers = team.exchange.layers();
  for (const auto& [id, layer] : layers) {
    if (id <= team.self()) continue;
    (void)compared.at(id, team.exchange.epoch(), layer.epoch);
    if (const auto withdrawn = compared.heed(id, firmness(layers, team.self(), id))) edges.push_back(*withdrawn);
  }
  return edges;
}

std::string deployment_fault(const TeamView& team, const ComparedPeer* compared, RobotId peer) {
  const auto T_own_peer = deployed_between(team.exchange.layers(), team.self(), peer);
  if (!T_own_peer) return {};
  if (const auto found = team.poses.odom_between(team.self(), peer))
    return matching::agrees(*T_own_peer, *found) ? "" : contradiction(T_own_peer->mean, *found);
  const bool compares = compared != nullptr && compared->match != nullptr;
  if (const auto denied = compares ? compared->match->denied() : std::nullopt)
    return contradiction(T_own_peer->mean, *denied);
  const bool refuted = compared != nullptr && compared->deployment_refuted;
  return refuted ? "; the maps contradict the deployments of the two" : "";
}

}  // namespace cairn::team
