// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fusion/merging/voxel_positions.hpp"
#include "fusion/team/team.hpp"
#include "hal/result.hpp"

namespace cairn::team {

/// Where each occupied voxel of the team's map is in the team's frame, and how well that is known: see
/// merging::voxel_positions(). The maps are the submaps of all robots in it, as they were published. Each lies as
/// surely as all claims and odometry together say of it against the first submap of the anchor, which is certain.
/// Errors: those of merging::voxel_positions().
[[nodiscard]] Result<std::vector<merging::VoxelPosition>> team_positions(const Team& team);

}  // namespace cairn::team
