// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "onboard/app/team/team_task.hpp"
#include "onboard/mapping/tree/position_figures.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

/// Adds the team and every peer that was heard to the report, as this robot knew them at the end of the run.
void add_team(const TeamTask& task, report::RunReport& report);

/// All names of files that write_team() may leave.
inline constexpr std::array<std::string_view, 4> kTeamFiles{"team.cairn", "team.tum", "team.ot", "team_positions.ply"};

/// What write_team() has left.
struct TeamFiles {
  std::vector<std::filesystem::path> same;  ///< the same on every robot
  std::optional<mapping::PositionFigures> positions;
};

/// Writes into `out`:
/// - team.cairn and team.ot: the map of the team, in the first odom frame of its anchor
/// - team.tum: one line for each robot, with its id as the stamp and its newest T_team_odom as the pose
/// - team_positions.ply, where a teammate is merged: see merging::save_positions() and team::team_positions(). A map of
///   more than two million occupied voxels goes without.
Result<TeamFiles> write_team(const team::Team& team, const std::filesystem::path& out);

}  // namespace cairn::app
