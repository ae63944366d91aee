// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "hal/result.hpp"
#include "tools/team/kill_plan.hpp"
#include "tools/team/network/network.hpp"
#include "tools/team/process.hpp"

namespace cairn::team_run {

/// A robot's two processes, to be started: its core, and its peer process.
struct RobotProcesses {
  std::string name;
  Command core, peers;
};

struct Supervision {
  std::vector<RobotProcesses> robots;
  std::vector<Kill> kills;
  Duration longest{};                           ///< cores that run longer are ended: a failure
  Duration grace = std::chrono::seconds(20);    ///< between being asked to end and being killed
  std::function<bool()> stop;                   ///< called often; true: end early
  std::function<void(const std::string&)> say;  ///< one line about what happened
  std::function<void(Duration)> progress;       ///< called often, with the time since the start
};

struct RobotEnd {
  int exit_code = -1;        ///< of the core
  std::size_t kills = 0;     ///< of the peer process, by plan
  std::size_t restarts = 0;  ///< of the peer process, after any death
};

struct TeamEnd {
  std::vector<RobotEnd> robots;
  std::optional<Index> failed;  ///< the robot whose core failed before any was asked to end
  bool stopped = false;         ///< the cores were asked to end: by `stop`, after a failure, or too late
  Duration took{};              ///< from the start to the end of the last core
};

/// Starts every robot's processes, and moves what they send. Peer processes that die are started again. It returns when
/// all cores have ended, and ends their peer processes then. If one core fails, the others are ended: there is nothing
/// left to compare. Errors: kIo (a process cannot be started).
Result<TeamEnd> supervise(const Supervision& supervision, Network& network, const Clock& clock);

}  // namespace cairn::team_run
