// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/team/network/link_config.hpp"

namespace cairn::team {

struct TeamOptions {
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path config;  ///< profile of every robot; defaults without one
  std::filesystem::path out;     ///< gets a folder for each robot, team.json and team.png
  LinkConfig link;
  double resolution_m = 0;            ///< of the maps; 0: the profile's
  double settle_s = 60;               ///< goes on so long after the end of the longest recording
  std::size_t kills = 0;              ///< of each peer process, at seeded moments
  bool loopback = false;              ///< no network namespaces, even where they are allowed
  std::filesystem::path core, peers;  ///< the programs
  std::function<void(const std::string&)> say;
  std::function<void(double seconds, double of)> progress;
  std::function<bool()> stop;
};

/// What a run of a team came to.
struct TeamOutcome {
  std::string json, table;  ///< team.json, and the same for people
  bool sound = false;       ///< all who claim to be merged have one map, and no merge is wrong
};

/// Runs the robots of `recordings`, each with its own processes, compares what they leave, and writes it to `out`.
/// Errors: those of recordings and profile (kInvalidConfig), of the system, and kIo with the log to look at where a
/// robot failed or the run was ended early.
Result<TeamOutcome> run_team(const TeamOptions& options);

}  // namespace cairn::team
