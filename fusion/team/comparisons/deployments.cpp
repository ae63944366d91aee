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

std::optional<UncertainPose> deployment_in(const peers::Layer& layer) {
  const auto item = layer.holding.items().find(peers::ItemId::deployment());
  if (item == layer.holding.items().end()) return std::nullopt;
  const auto deployment = peers::decode_deployment(item->second.payload);
  return deployment ? std::optional(deployment->T_site_odom) : std::nullopt;
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
  const auto layer_a = layers.find(a), layer_b = layers.find(b);
  const auto T_site_a = layer_a != layers.end() ? deployment_in(layer_a->second) : std::nullopt;
  const auto T_site_b = layer_b != layers.end() ? deployment_in(layer_b->second) : std::nullopt;
  if (!T_site_a || !T_site_b) return std::nullopt;
  return compose(inverse(*T_site_a), *T_site_b);
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

std::string deployment_fault(const TeamView& team, const ComparedPeer* compared, RobotId peer) {
  const auto T_own_peer = deployed_between(team.exchange.layers(), team.self(), peer);
  if (!T_own_peer) return {};
  if (const auto found = team.poses.odom_between(team.self(), peer))
    return matching::agrees(*T_own_peer, *found) ? "" : contradiction(T_own_peer->mean, *found);
  const bool refuted = compared != nullptr && compared->deployment_refuted;
  return refuted ? "; the maps contradict the deployments of the two" : "";
}

}  // namespace cairn::team
