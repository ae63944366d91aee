// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/team/network/link_config.hpp"

namespace cairn::team_run {

struct TeamOptions {
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path config;  ///< profile of every robot; without one: those of the recordings, or the defaults
  std::filesystem::path out;     ///< gets a folder for each robot, team.json and team.png
  bool overwrite = false;        ///< `out` may hold the results of an earlier run
  LinkConfig link;
  double resolution_m = 0;            ///< of the maps; 0: the profile's
  double settle_s = 60;               ///< the run goes on so long after the end of the longest recording
  std::size_t kills = 0;              ///< of each peer process, at seeded moments
  bool loopback = false;              ///< no network namespaces, even if they are allowed
  std::filesystem::path core, peers;  ///< the robot's two programs
  std::function<void(const std::string&)> say;
  std::function<void(double seconds, double of)> progress;
  std::function<bool()> stop;
};

/// The result of a run of a team.
struct TeamOutcome {
  std::string json, table;  ///< team.json, and the same for people
  bool sound = false;       ///< all robots that are merged have one map, and no merge is wrong
};

/// Runs the robots of `recordings`, each with its own processes. Then it compares their results and writes the
/// comparison to `out`. Errors: those of recordings and profile (kInvalidConfig), those of the system, and kIo if
/// `out` is in use, or a robot failed, or the run was ended early; the error names the log.
Result<TeamOutcome> run_team(const TeamOptions& options);

}  // namespace cairn::team_run
