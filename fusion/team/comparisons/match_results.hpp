// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/team/comparisons/compared_peers.hpp"
#include "fusion/team/comparisons/match_job.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "fusion/team/graph/indexed_edge.hpp"
#include "hal/time.hpp"

namespace cairn::team {

/// Takes in a job that has come back, run or not. Returns the edge to be published now, if any: where
/// the peer is once that is sure, or that it is not sure any more. A job is void, and changes nothing,
/// if one of the two robots has begun anew since it was handed out.
[[nodiscard]] std::optional<IndexedEdge> take_result(MatchJob job, const TeamView& team, ComparedPeers& compared,
                                                     Time now);

}  // namespace cairn::team
