// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fusion/team/peer_state.hpp"
#include "onboard/app/live/live_view.hpp"
#include "tools/cli/doctor/finding.hpp"

namespace cairn::cli {

/// Which peer is asked about, and where its state is read. The first source that is not empty counts.
struct PeerQuestion {
  std::string name;                 ///< of the peer; "all": each peer
  std::filesystem::path recording;  ///< of a robot in a team; it is replayed
  std::filesystem::path run;        ///< folder of a finished run, with report.json
  std::filesystem::path live_view;  ///< socket of a running core
};

/// What people can do about a peer of this name that is in this state; empty for kMerged.
[[nodiscard]] std::string remedy_for(team::PeerState state, const std::string& peer);
/// One finding per peer: whether it is merged, and what to do if not.
[[nodiscard]] Findings examine_peer(const PeerQuestion& question);
/// The same for peers whose state is known already.
[[nodiscard]] Findings judge_peers(const std::vector<app::LiveView::Peer>& peers, const std::string& name);

}  // namespace cairn::cli
