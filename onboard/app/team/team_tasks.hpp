// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "onboard/app/team/team_task.hpp"
#include "onboard/scheduler/executive.hpp"

namespace cairn {

struct RobotProfile;

/// The two tasks of a robot's part in its team, their lines and what joins them.
class TeamTasks {
 public:
  /// Adds the lines. `mapping` is that of the task that hands over tiles, through its slot `tiles_slot`. All must
  /// outlive the tasks.
  TeamTasks(scheduler::Executive& executive, const RobotProfile& profile, const scheduler::Line& mapping,
            std::size_t tiles_slot, Monitor& monitor);

  [[nodiscard]] TileChannel& tiles() { return tiles_; }
  [[nodiscard]] TeamTask& team() { return team_; }
  [[nodiscard]] const TeamTask& team() const { return team_; }

 private:
  scheduler::Line &team_line_, &match_line_;
  TileChannel tiles_;
  MatchChannel jobs_, results_;
  TeamTask team_;
  MatchTask match_;
};

}  // namespace cairn
