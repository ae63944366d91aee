// SPDX-License-Identifier: Apache-2.0
// Where robots say that they were put down: a guess for comparing their maps, and, where it is exact, all that is known
// until the maps themselves say where they belong. A deployment may be wrong: the maps have the last word.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "fusion/matching/belief/guess.hpp"
#include "fusion/team/team.hpp"

namespace cairn {
namespace {

using peers::RobotId;

constexpr std::uint16_t kDeployedEdges = 0xC000;
constexpr double kDegree = std::numbers::pi / 180, kExactRad = 0.5 * kDegree;

/// Whether it is as good as what the maps can say.
bool exact(const UncertainPose& T, double voxel_m) {
  const Vector6 sigma = T.covariance.diagonal().cwiseSqrt();
  return sigma.head<3>().maxCoeff() <= voxel_m && sigma[5] <= kExactRad;
}

std::optional<UncertainPose> deployment_in(const peers::Layer& layer) {
  const auto item = layer.holding.items().find(peers::ItemId::deployment());
  if (item == layer.holding.items().end()) return std::nullopt;
  const auto deployment = peers::decode_deployment(item->second.payload);
  return deployment ? std::optional(deployment->T_site_odom) : std::nullopt;
}

}  // namespace

std::optional<UncertainPose> Team::deployed(RobotId peer) const {
  const auto& layers = exchange_.layers();
  const auto other = layers.find(peer);
  const auto T_site_own = deployment_in(layers.at(config_.id));
  const auto T_site_peer = other != layers.end() ? deployment_in(other->second) : std::nullopt;
  if (!T_site_own || !T_site_peer) return std::nullopt;
  return compose(inverse(*T_site_own), *T_site_peer);
}

void Team::say_deployments() {
  for (const auto& [peer, layer] : exchange_.layers()) {
    const auto T_own_peer = peer > config_.id ? deployed(peer) : std::nullopt;
    if (!T_own_peer) continue;
    const Pair& pair = pair_with(peer, layer.epoch);
    const auto id = peers::ItemId::edge(static_cast<std::uint16_t>(kDeployedEdges + pair.edge));
    const bool stands = exact(*T_own_peer, config_.resolution_m) && !pair.found && !pair.deployment_refuted;
    if (!stands && !exchange_.layers().at(config_.id).holding.items().contains(id)) continue;
    const float probability = stands ? static_cast<float>(1 - matching::kWrongGuess) : 0;
    exchange_.say(id, encode(peers::Edge{0, peer, layer.epoch, 0, *T_own_peer, probability}));
  }
}

/// After a comparison: whether the maps say no to it, or agree with another place.
void Team::weigh_deployment(RobotId peer, Pair& pair) const {
  const matching::PendingHypotheses& hypotheses = pair.match->hypotheses();
  pair.found = hypotheses.accepted() != nullptr;
  const auto T_own_peer = deployed(peer);
  pair.deployment_refuted = T_own_peer && std::ranges::any_of(hypotheses.all(), [&](const matching::Hypothesis& h) {
                              const bool dropped = h.standing == matching::Standing::kDropped;
                              return matching::agrees(*T_own_peer, h.T_a_b.mean) ? dropped : h.agreements > 0;
                            });
}

std::string Team::deployment_fault(RobotId peer) const {
  const auto T_own_peer = deployed(peer);
  if (!T_own_peer) return {};
  const auto own = poses_.T_team_odom.find(config_.id), other = poses_.T_team_odom.find(peer);
  if (own != poses_.T_team_odom.end() && other != poses_.T_team_odom.end()) {
    const SE3 found = own->second.inverse() * other->second;
    if (matching::agrees(*T_own_peer, found)) return {};
    const SE3 off = T_own_peer->mean.inverse() * found;
    char text[120];
    std::snprintf(text, sizeof text, "; the deployments of the two contradict that by %.1f m and %.1f degrees",
                  off.translation().norm(), rotation_angle(off) / kDegree);
    return text;
  }
  const auto pair = pairs_.find(peer);
  const bool refuted = pair != pairs_.end() && pair->second.deployment_refuted;
  return refuted ? "; the maps contradict the deployments of the two" : "";
}

}  // namespace cairn
