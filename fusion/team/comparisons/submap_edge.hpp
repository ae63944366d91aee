// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/peers/items/claim.hpp"
#include "fusion/team/comparisons/match_job.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "hal/se3.hpp"

namespace cairn::team {

/// Where one whole map lies in another, as an edge between two submaps: of those whose place in odom is
/// known, the two that have most tiles in common there. `T_own_other` is of the frames of the job's maps.
/// The edge's probability is left 0.
[[nodiscard]] peers::Edge submap_edge(const MatchJob& job, const UncertainPose& T_own_other, const TeamView& team);

}  // namespace cairn::team
