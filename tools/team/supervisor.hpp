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

namespace cairn::team {

/// A robot's two processes, to be started: its core, and the process that speaks to other machines.
struct RobotProcesses {
  std::string name;
  Command core, peers;
};

struct Supervision {
  std::vector<RobotProcesses> robots;
  std::vector<Kill> kills;
  Duration longest{};                           ///< cores that still run then are ended, which is a failure
  Duration grace = std::chrono::seconds(20);    ///< between being asked to end and being killed
  std::function<bool()> stop;                   ///< true: end early
  std::function<void(const std::string&)> say;  ///< one line about what happened
  std::function<void(Duration)> progress;       ///< called often
};

struct RobotEnd {
  int exit_code = -1;        ///< of the core
  std::size_t kills = 0;     ///< of the peer process, by plan
  std::size_t restarts = 0;  ///< of the peer process, whatever it died of
};

struct TeamEnd {
  std::vector<RobotEnd> robots;
  std::optional<Index> failed;  ///< the robot whose core failed before any was asked to end
  bool stopped = false;         ///< before the cores ended by themselves: asked to, a core that failed, or too late
  Duration took{};
};

/// Starts every robot's processes, moves what they send, starts peer processes again that die, and returns when all
/// cores have ended; their peer processes are ended then. One core that fails ends the others: there is nothing left to
/// compare. Errors: kIo (a process cannot be started).
Result<TeamEnd> supervise(const Supervision& supervision, Network& network, const Clock& clock);

}  // namespace cairn::team
