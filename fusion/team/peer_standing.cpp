// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/peer_standing.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "fusion/team/comparisons/deployments.hpp"

namespace cairn::team {
namespace {

using peers::RobotId;

template <class... Numbers>
std::string text(const char* format, Numbers... numbers) {
  char line[200];
  std::snprintf(line, sizeof line, format, numbers...);
  return line;
}

/// What was decided last about the likeliest place, and the figures it was decided by.
std::string verdict(const matching::Hypothesis& place) {
  const matching::Evidence& e = place.evidence;
  return place.reason + text(" (probability %.2f, %.0f m² agree, overlap %.2f, conflict %.3f, uniqueness %.2f)",
                             place.probability_correct, e.agreeing_m2, e.overlap,
                             std::max(e.conflict, e.reverse_conflict), e.uniqueness);
}

PeerState state_of(const matching::Hypothesis& place) {
  if (place.standing == matching::Standing::kDropped) return PeerState::kContradicted;
  if (place.rivalled) return PeerState::kAmbiguous;
  return place.agreements > 0 ? PeerState::kAgreeing : PeerState::kUndecided;
}

PeerStanding standing(PeerState state, std::string reason) {
  return {.state = state, .reason = std::move(reason), .deployment_contradicted = false};
}

/// The same, and what the maps say of the deployments.
PeerStanding standing_with_deployments(PeerState state, const std::string& reason, const std::string& fault) {
  return {.state = state, .reason = reason + fault, .deployment_contradicted = !fault.empty()};
}

/// What keeps the two from exchanging maps; nothing if they do.
std::optional<PeerStanding> obstacle(RobotId peer, const TeamView& team, Time now) {
  using enum PeerState;
  const peers::Exchange& exchange = team.exchange;
  const auto found = exchange.links().find(peer);
  const bool layer = exchange.layers().contains(peer);
  if (found == exchange.links().end())
    return layer ? std::nullopt : std::optional(standing(kNeverHeard, "never heard of"));
  const peers::Link& link = found->second;
  if (link.conduct.banned(now)) return standing(kBanned, "banned: it sent too many invalid packets");
  if (link.unsupported > 0 && link.last_heard == Time::min())
    return standing(kOtherVersion, "it speaks another version of the peers' format");
  if (link.last_heard == Time::min()) return standing(kUnreadable, "nothing that it sent could be read");
  if (link.voxel_um != 0 && !exchange.alike(link))
    return standing(kOtherResolution,
                    text("its map has voxels of %.3f m, this one's %.3f m", 1e-6 * link.voxel_um, team.resolution_m));
  if (!exchange.hears(peer, now))
    return standing(kNoLink, text("no link: not heard for %.0f s", to_seconds(now - link.last_heard)));
  if (!layer) return standing(kNoMap, "it has said nothing of its map yet");
  return std::nullopt;
}

/// Of a peer of a higher id, whose map this robot compares with its own.
PeerStanding outcome(RobotId peer, const TeamView& team, const ComparedPeer* compared) {
  using enum PeerState;
  if (compared == nullptr || !compared->match) return standing(kBeingCompared, "being compared");
  const auto places = compared->match->hypotheses().all();
  if (places.empty()) return standing(kNoPlace, "no place found where the maps overlap");
  if (compared->edge.stands()) return standing(kAtOdds, "found, but at odds with what others found");
  return standing_with_deployments(state_of(places.front()), verdict(places.front()),
                                   deployment_fault(team, compared, peer));
}

}  // namespace

PeerStanding standing_of(RobotId peer, const TeamView& team, const ComparedPeers& compared, std::size_t least_tiles,
                         Time now) {
  using enum PeerState;
  const ComparedPeer* entry = compared.find(peer);
  if (team.poses.T_team_odom.contains(peer))
    return standing_with_deployments(kMerged, "merged", deployment_fault(team, entry, peer));
  if (auto why = obstacle(peer, team, now)) return *std::move(why);
  const std::size_t own = team.tiles.walls_of(team.self()), other = team.tiles.walls_of(peer);
  if (std::min(own, other) < least_tiles)
    return standing(kTooLittleMapped,
                    text("too little mapped: %zu and %zu tiles with walls, %zu needed", own, other, least_tiles));
  if (peer < team.self())
    return standing(kPeerCompares, "it compares the two maps, and has not found where they belong together");
  return outcome(peer, team, entry);
}

}  // namespace cairn::team
