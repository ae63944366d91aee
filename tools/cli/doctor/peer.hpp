// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fusion/team/peer_state.hpp"
#include "onboard/app/live/live_view.hpp"
#include "tools/cli/doctor/finding.hpp"

namespace cairn::cli {

/// Where there is something to be heard of peers; the first that is named counts.
struct PeerQuestion {
  std::string name;                 ///< of the peer; "all": of each
  std::filesystem::path recording;  ///< of a robot in a team: it is played again
  std::filesystem::path run;        ///< what a run left: its report.json
  std::filesystem::path live_view;  ///< of a running core
};

/// What people can do about a peer that is in this state; empty for kMerged.
[[nodiscard]] const char* remedy_for(PeerState state);
/// One finding per peer: whether it is merged, and what to do if not.
[[nodiscard]] Findings examine_peer(const PeerQuestion& question);
/// The same of what is known already.
[[nodiscard]] Findings judge_peers(const std::vector<LiveView::Peer>& peers, const std::string& name);

}  // namespace cairn::cli
