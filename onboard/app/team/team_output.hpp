// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "hal/result.hpp"
#include "onboard/app/team/team_task.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

/// Of everyone that was heard, as this robot saw it at the end of the run.
void add_team(const TeamTask& task, report::RunReport& report);

/// Writes team.cairn, team.ot and team.tum into `out`: the team's map in the odom frame that its anchor began with,
/// and one line for each robot whose stamp is its id and whose pose is T_team_odom, where its odom lies by now. Returns
/// the files that are the same on every robot.
Result<std::vector<std::filesystem::path>> write_team(const team::Team& team, const std::filesystem::path& out);

}  // namespace cairn::app
