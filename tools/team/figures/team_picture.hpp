// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "hal/result.hpp"
#include "tools/team/figures/robot_result.hpp"

namespace cairn::team {

/// The map of the largest team from above, in the team's frame, with the ways of its robots, each in a colour of its
/// own and with its name at its end, as a PNG. Errors: those of look_at(), draw_map() and encode_png().
[[nodiscard]] Result<std::vector<std::byte>> draw_team(const std::vector<RobotResult>& robots);

}  // namespace cairn::team
