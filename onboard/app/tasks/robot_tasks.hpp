// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "hal/workers.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/app/restart/restart.hpp"
#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/odometry_task.hpp"
#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/app/team/team_tasks.hpp"
#include "onboard/scheduler/idle_task.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {

/// The tasks of one robot and the graph that connects them. What a live run adds (recording, saving, publishing) is
/// not in it; see LiveRun.
class RobotTasks {
 public:
  /// `sources`: what the robot reads from; with peers among them, the robot takes part in its team. All must outlive
  /// the tasks.
  RobotTasks(std::span<const recording::SourceEntry> sources, const RobotProfile& profile, const RunOptions& options,
             const PreviousRun& previous, Monitor& monitor);
  RobotTasks(const RobotTasks&) = delete;
  RobotTasks& operator=(const RobotTasks&) = delete;
  ~RobotTasks() = default;

  const safety::Fitted fitted;
  Workers odometry_workers, mapping_workers;
  Robot robot;
  SafetyTask safety;
  DriveTask drive;
  ReceiveTask receive;
  OdometryTask odometry;
  MappingTask mapping;
  scheduler::IdleTask reference;  ///< as often as the control task
  scheduler::TaskGraph graph;
  std::optional<TeamTasks> team;  ///< none: this robot takes part in no team

 private:
  void add_tasks(const ScheduleProfile& schedule);
  void connect_safety(const ScheduleProfile& schedule);
  void connect_map(bool live);
};

}  // namespace cairn::app
