// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/team/match_task.hpp"
#include "onboard/app/team/team_task.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {

struct RobotProfile;

/// The two tasks of a robot's part in its team.
class TeamTasks {
 public:
  /// Ports of other tasks.
  struct Others {
    scheduler::OutputPort<TileBatch>& tiles;
    scheduler::InputPort<Mates>& mates;
    scheduler::OutputPort<clients::Placement>& places;
    scheduler::OutputPort<GeoFix>& fixes;
  };
  /// Adds the tasks to the graph, after the others, and connects all. All must outlive the tasks.
  TeamTasks(scheduler::TaskGraph& graph, const RobotProfile& profile, const Others& others, Monitor& monitor);

  [[nodiscard]] TeamTask& team() { return team_; }
  [[nodiscard]] const TeamTask& team() const { return team_; }
  [[nodiscard]] const MatchTask& matching() const { return matching_; }

 private:
  TeamTask team_;
  MatchTask matching_;
};

}  // namespace cairn::app
