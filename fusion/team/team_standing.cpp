// SPDX-License-Identifier: Apache-2.0
// Why a peer's map is, or is not, a part of the team's: what people ask when nothing merges.
#include <algorithm>
#include <cstdio>

#include "fusion/team/team.hpp"

namespace cairn {
namespace {

template <class... Numbers>
std::string text(const char* format, Numbers... numbers) {
  char line[200];
  std::snprintf(line, sizeof line, format, numbers...);
  return line;
}

/// What was decided last about the likeliest place, and by which figures.
std::string verdict(const matching::Hypothesis& h) {
  const matching::Evidence& e = h.evidence;
  return h.reason + text(" (probability %.2f, %.0f m² agree, overlap %.2f, conflict %.3f, uniqueness %.2f)",
                         h.probability_correct, e.agreeing_m2, e.overlap, std::max(e.conflict, e.reverse_conflict),
                         e.uniqueness);
}

PeerState state_of(const matching::Hypothesis& h) {
  if (h.standing == matching::Standing::kDropped) return PeerState::kContradicted;
  if (h.rivalled) return PeerState::kAmbiguous;
  return h.agreements > 0 ? PeerState::kAgreeing : PeerState::kUndecided;
}

}  // namespace

/// What keeps the two from exchanging maps at all; nothing: they do.
std::optional<PeerStanding> Team::obstacle(peers::RobotId peer, Time now) const {
  using enum PeerState;
  const auto found = exchange_.links().find(peer);
  const bool layer = exchange_.layers().contains(peer);
  if (found == exchange_.links().end())
    return layer ? std::nullopt : std::optional<PeerStanding>({kNeverHeard, "never heard of"});
  const peers::Link& link = found->second;
  if (link.conduct.banned(now)) return PeerStanding{kBanned, "banned: it sent too much that cannot be"};
  if (link.unsupported > 0 && link.last_heard == Time::min())
    return PeerStanding{kOtherVersion, "it speaks another version of the peers' format"};
  if (link.last_heard == Time::min()) return PeerStanding{kUnreadable, "nothing that it sent could be read"};
  if (link.voxel_um != 0 && !exchange_.alike(link))
    return PeerStanding{kOtherResolution, text("its map has voxels of %.3f m, this one's %.3f m", 1e-6 * link.voxel_um,
                                               config_.resolution_m)};
  if (!exchange_.hears(peer, now))
    return PeerStanding{kNoLink, text("no link: not heard for %.0f s", to_seconds(now - link.last_heard))};
  if (!layer) return PeerStanding{kNoMap, "it has said nothing of its map yet"};
  return std::nullopt;
}

PeerStanding Team::standing(peers::RobotId peer, Time now) const {
  using enum PeerState;
  const auto with_deployment = [this, peer](PeerState state, const std::string& reason) {
    const std::string fault = deployment_fault(peer);
    return PeerStanding{state, reason + fault, !fault.empty()};
  };
  if (poses_.T_team_odom.contains(peer)) return with_deployment(kMerged, "merged");
  if (auto why = obstacle(peer, now)) return std::move(*why);
  const std::size_t own = walls_of(config_.id), other = walls_of(peer);
  if (std::min(own, other) < config_.least_tiles)
    return {kTooLittleMapped,
            text("too little mapped: %zu and %zu tiles with walls, %zu needed", own, other, config_.least_tiles)};
  if (peer < config_.id)
    return {kPeerCompares, "it compares the two maps, and has not found where they belong together"};
  const auto pair = pairs_.find(peer);
  if (pair == pairs_.end() || !pair->second.match) return {kBeingCompared, "being compared"};
  const auto hypotheses = pair->second.match->hypotheses().all();
  if (hypotheses.empty()) return {kNoPlace, "no place found where the maps overlap"};
  if (pair->second.said && pair->second.said->probability > 0)
    return {kAtOdds, "found, but at odds with what others found"};
  return with_deployment(state_of(hypotheses.front()), verdict(hypotheses.front()));
}

}  // namespace cairn
