// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/published_claims.hpp"

#include <Eigen/Cholesky>
#include <array>

#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/own_submaps.hpp"
#include "fusion/team/graph/indexed_edge.hpp"

namespace cairn::team {
namespace {

using peers::ItemId;
using peers::RobotId;

constexpr double kLeastVariance = 1e-12;  // m², rad²: nothing is known to a micrometre

bool regular(const Matrix6& covariance) {
  return Matrix6(covariance - kLeastVariance * Matrix6::Identity()).llt().info() == Eigen::Success;
}

bool holds(const peers::Edge& edge, RobotId publisher, const peers::Layers& layers) {
  if (edge.probability == 0 || edge.other == publisher || !regular(edge.T_own_other.covariance)) return false;
  const auto other = layers.find(edge.other);
  return other != layers.end() && other->second.epoch == edge.other_epoch;
}

void add_claims(RobotId publisher, const peers::Layers& layers, std::vector<PairClaim>& claims) {
  const auto& items = layers.at(publisher).holding.items();
  const auto end = items.lower_bound(ItemId::deployment());
  std::array<std::size_t, 4> counts{};  // by origin
  for (auto item = items.lower_bound(ItemId::edge(0)); item != end; ++item) {
    const EdgeOrigin origin = origin_of(item->first.submap());
    if (++counts.at(static_cast<std::size_t>(origin)) > kMostClaimsPerOrigin) continue;
    const auto edge = peers::decode_edge(item->second.payload);
    if (!edge || !holds(*edge, publisher, layers)) continue;
    claims.push_back({.a = publisher,
                      .b = edge->other,
                      .T_a_b = edge->T_own_other,
                      .probability = static_cast<double>(edge->probability),
                      .submap_a = edge->own_submap,
                      .submap_b = edge->other_submap,
                      .refined = origin == EdgeOrigin::kRefined});
  }
}

}  // namespace

std::vector<PairClaim> published_claims(const peers::Layers& layers) {
  std::vector<PairClaim> claims;
  for (const auto& [robot, layer] : layers) add_claims(robot, layers, claims);
  return claims;
}

SubmapChains published_chains(const peers::Layers& layers) {
  SubmapChains chains;
  for (const auto& [robot, layer] : layers) {
    const auto& items = layer.holding.items();
    for (std::uint16_t k = 1; k < peers::OwnSubmaps::kMost; ++k) {
      const auto item = items.find(ItemId::submap(k));
      if (item == items.end()) break;
      const auto submap = peers::decode_submap(item->second.payload);
      if (!submap || !regular(submap->T_odom_submap.covariance)) break;
      chains[robot].push_back(submap->T_odom_submap);
    }
  }
  return chains;
}

}  // namespace cairn::team
