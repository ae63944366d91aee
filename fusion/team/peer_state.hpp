// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace cairn::team {

/// Why a peer's map is, or is not, a part of the team's map.
enum class PeerState : std::uint8_t {
  kMerged,
  kNeverHeard,
  kBanned,           ///< it sent too much that cannot be
  kOtherVersion,     ///< it speaks another version of the peers' format
  kUnreadable,       ///< nothing that it sent could be read
  kOtherResolution,  ///< its voxels have another size
  kNoLink,           ///< it was heard, but not for some seconds
  kNoMap,            ///< it has said nothing of its map yet
  kTooLittleMapped,  ///< one of the two maps has too few tiles with walls
  kPeerCompares,     ///< the peer compares the two maps, and has found nothing yet
  kBeingCompared,    ///< this robot compares the two maps, for the first time
  kNoPlace,          ///< no place was found where the maps overlap
  kAtOdds,           ///< a place was found that does not fit to what other robots found
  kAmbiguous,        ///< another place fits about as well
  kAgreeing,         ///< the maps agreed on new ground, but not often enough yet
  kContradicted,     ///< the maps contradict the place that was found
  kUndecided,        ///< compared, and neither accepted nor refused
};
inline constexpr std::size_t kPeerStates = 17;

/// The name in report.json and in the live view, such as "no_link". Names never change their meaning.
[[nodiscard]] std::string_view to_string(PeerState state);
/// The inverse; none for any other text.
[[nodiscard]] std::optional<PeerState> peer_state_from(std::string_view name);

}  // namespace cairn::team
