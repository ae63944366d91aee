// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/peer_state.hpp"

#include <algorithm>
#include <array>

namespace cairn::team {
namespace {

constexpr std::array<std::string_view, kPeerStates> kNames{
    "merged",   "never_heard",       "banned",        "other_version",  "unreadable", "other_resolution", "no_link",
    "no_map",   "too_little_mapped", "peer_compares", "being_compared", "no_place",   "at_odds",          "ambiguous",
    "agreeing", "contradicted",      "undecided"};
static_assert(static_cast<std::size_t>(PeerState::kUndecided) + 1 == kPeerStates);

}  // namespace

std::string_view to_string(PeerState state) { return kNames[static_cast<std::size_t>(state)]; }

std::optional<PeerState> peer_state_from(std::string_view name) {
  const auto* found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<PeerState>(found - kNames.begin());
}

}  // namespace cairn::team
