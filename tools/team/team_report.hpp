// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/team/figures/team_figures.hpp"
#include "tools/team/figures/team_recordings.hpp"
#include "tools/team/network/network.hpp"
#include "tools/team/supervisor.hpp"

namespace cairn::team_run {

/// All that is known about a run of a team. The robots have the same order everywhere.
struct TeamReport {
  const std::vector<TeamRecording>& recordings;
  const Network& network;
  const TeamEnd& end;
  const TeamFigures& figures;
};

/// The content of team.json. Field names are fixed. Unknown values are null.
[[nodiscard]] nlohmann::ordered_json to_json(const TeamReport& report);
/// The same as a table for people.
[[nodiscard]] std::string to_table(const TeamReport& report);

}  // namespace cairn::team_run
