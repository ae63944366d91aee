// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_results.hpp"

#include <utility>

#include "fusion/team/comparisons/deployments.hpp"
#include "fusion/team/comparisons/submap_edge.hpp"

namespace cairn::team {
namespace {

PlaceStanding likeliest_in(const matching::PendingHypotheses& places) {
  const auto all = places.all();
  if (all.empty()) return {};
  return {.standing = all.front().standing, .agreements = all.front().agreements};
}

std::optional<IndexedEdge> refined_edge(const MatchJob& job, ComparedPeers& compared) {
  const Refinement& refinement = *job.refinement;
  PublishedEdge* edge = compared.refinements().edge(refinement.submaps);
  if (!refinement.found || edge == nullptr) return std::nullopt;
  return edge->update(peers::Edge{.own_submap = refinement.submaps.own,
                                  .other = job.peer,
                                  .other_epoch = job.peer_epoch,
                                  .other_submap = refinement.submaps.other,
                                  .T_own_other = *refinement.found,
                                  .probability = static_cast<float>(refinement.probability)});
}

std::optional<IndexedEdge> whole_map_edge(const MatchJob& job, const TeamView& team, ComparedPeer& peer) {
  std::optional<peers::Edge> edge;
  if (const matching::Hypothesis* accepted = peer.match->hypotheses().accepted()) {
    edge = submap_edge(job, accepted->T_a_b, team);
    edge->probability = static_cast<float>(accepted->probability_correct);
  }
  return peer.edge.update(edge);
}

void weigh_deployment(const MatchJob& job, const TeamView& team, ComparedPeer& peer) {
  const matching::PendingHypotheses& places = peer.match->hypotheses();
  const auto T_own_peer = deployed_between(team.exchange.layers(), team.self(), job.peer);
  peer.found = places.accepted() != nullptr;
  peer.deployment_refuted = T_own_peer && refutes(places, *T_own_peer);
}

}  // namespace

std::optional<IndexedEdge> take_result(MatchJob job, const TeamView& team, ComparedPeers& compared, Time now) {
  ComparedPeer* peer = compared.of(job, team.exchange.epoch());
  if (peer == nullptr) return std::nullopt;
  if (job.refinement) return refined_edge(job, compared);
  peer->match = std::move(job.match);
  if (!job.ran) return std::nullopt;
  const PlaceStanding before = std::exchange(peer->likeliest, likeliest_in(peer->match->hypotheses()));
  peer->worth.end(peer->likeliest != before, now);
  weigh_deployment(job, team, *peer);
  return whole_map_edge(job, team, *peer);
}

}  // namespace cairn::team
