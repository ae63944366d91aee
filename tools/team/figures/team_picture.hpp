// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "hal/result.hpp"
#include "tools/team/figures/robot_result.hpp"

namespace cairn::team_run {

/// A PNG of the largest team's map from above, in the team's frame, with the paths of its robots. Each path has a
/// colour of its own, and the robot's name at its end. Errors: those of look_at(), draw_map() and encode_png().
[[nodiscard]] Result<std::vector<std::byte>> draw_team(const std::vector<RobotResult>& robots);

}  // namespace cairn::team_run
