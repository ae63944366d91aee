// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "hal/result.hpp"
#include "onboard/app/team/team_task.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

/// Adds the team and every peer that was heard to the report, as this robot knew them at the end of the run.
void add_team(const TeamTask& task, report::RunReport& report);

/// Writes into `out`:
/// - team.cairn and team.ot: the map of the team, in the first odom frame of its anchor
/// - team.tum: one line for each robot, with its id as the stamp and its newest T_team_odom as the pose
///
/// Returns the files that are the same on every robot.
Result<std::vector<std::filesystem::path>> write_team(const team::Team& team, const std::filesystem::path& out);

}  // namespace cairn::app
