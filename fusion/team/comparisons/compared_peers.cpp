// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/compared_peers.hpp"

#include "fusion/team/graph/indexed_edge.hpp"

namespace cairn::team {

ComparedPeer& ComparedPeers::at(peers::RobotId peer, peers::Epoch own_epoch, peers::Epoch peer_epoch) {
  const auto [entry, added] = peers_.try_emplace(peer);
  ComparedPeer& compared = entry->second;
  if (added) compared.edge = PublishedEdge(edge_index(EdgeOrigin::kMatched, peers_.size() - 1));
  if (compared.own_epoch == own_epoch && compared.peer_epoch == peer_epoch) return compared;
  if (compared.own_epoch != own_epoch) refinements_.clear();
  refinements_.forget(peer);
  compared = ComparedPeer{.own_epoch = own_epoch,
                          .peer_epoch = peer_epoch,
                          .match = std::make_unique<matching::GrowingMatch>(),
                          .worth = MatchWorth(worth_),
                          .edge = PublishedEdge(compared.edge.index())};
  return compared;
}

std::optional<IndexedEdge> ComparedPeers::heed(peers::RobotId peer, std::uint64_t firm) {
  ComparedPeer& compared = peers_.at(peer);
  if (compared.firm == firm) return std::nullopt;
  refinements_.forget(peer);
  auto withdrawn = compared.edge.update(std::nullopt);
  compared = ComparedPeer{.own_epoch = compared.own_epoch,
                          .peer_epoch = compared.peer_epoch,
                          .firm = firm,
                          .match = std::make_unique<matching::GrowingMatch>(),
                          .worth = MatchWorth(worth_),
                          .edge = compared.edge};
  return withdrawn;
}

const ComparedPeer* ComparedPeers::find(peers::RobotId peer) const {
  const auto found = peers_.find(peer);
  return found == peers_.end() ? nullptr : &found->second;
}

ComparedPeer* ComparedPeers::of(const MatchJob& job, peers::Epoch own_epoch) {
  const auto found = peers_.find(job.peer);
  if (found == peers_.end()) return nullptr;
  ComparedPeer& compared = found->second;
  const bool same =
      compared.own_epoch == job.own_epoch && compared.peer_epoch == job.peer_epoch && compared.firm == job.firm;
  return same && job.own_epoch == own_epoch ? &compared : nullptr;
}

}  // namespace cairn::team
