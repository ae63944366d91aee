// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "hal/workers.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/app/restart/restart.hpp"
#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/housekeeping_task.hpp"
#include "onboard/app/tasks/odometry_task.hpp"
#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/app/tasks/recorder.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/app/tasks/saving_task.hpp"
#include "onboard/app/tasks/schedule_faults.hpp"
#include "onboard/app/tasks/telling.hpp"
#include "onboard/app/tasks/watch_task.hpp"
#include "onboard/app/team/team_tasks.hpp"
#include "onboard/scheduler/executive.hpp"

namespace cairn {

/// Does nothing, as often as the control task: what it misses is the machine's doing.
class IdleTask final : public scheduler::Task {
 public:
  void tick(scheduler::Tick& /*tick*/) override {}
};

/// A robot's tasks, joined by their channels, ready to be run by their executive.
class RobotTasks {
 public:
  /// All must outlive the tasks. `before`: of an earlier run that this one goes on from, or that it must not be
  /// confused with.
  RobotTasks(Door& door, const RobotProfile& profile, const RunOptions& options, const Before& before,
             Monitor& monitor);
  RobotTasks(const RobotTasks&) = delete;
  RobotTasks& operator=(const RobotTasks&) = delete;
  ~RobotTasks() = default;

  /// Live, until `stop`; leaves schedule.log and, where it is asked for, a recording. Error: they could not be made.
  /// `generations`: where the map is saved; null: nowhere.
  Result<void> run_live(const Clock& clock, Generations* generations);
  /// The recording behind the door, at its pace.
  Result<void> replay();

  [[nodiscard]] const Robot& robot() const { return robot_; }
  [[nodiscard]] const ReceiveTask::Figures& figures() const { return receive_.figures(); }
  [[nodiscard]] const MappingTask& mapping() const { return mapping_; }
  [[nodiscard]] const FailsafeDecision& decision() const { return safety_.decision(); }
  [[nodiscard]] const std::optional<DriveState>& drive_state() const { return drive_.state(); }
  [[nodiscard]] const scheduler::Executive& executive() const { return executive_; }
  /// Null: this robot takes part in no team.
  [[nodiscard]] const TeamTask* team() const { return team_ ? &team_->team() : nullptr; }

 private:
  Result<void> connect(Recorder* recorder);
  Result<std::optional<Recorder>> open_recorder();
  [[nodiscard]] Pulse add_saving(SavingTask& saving);
  void say_what_is_missing(Time now);
  [[nodiscard]] bool played_out(Time now) const;
  void note_changes();
  void become_real_time();
  scheduler::Line& add_live_only(const scheduler::TaskSpec& spec, scheduler::Task& task);
  void tell(Telling& telling, FaultSet faults, Time now);
  [[nodiscard]] Time first_arrival();

  Door& door_;
  const RobotProfile& profile_;
  const RunOptions& options_;
  const Before& before_;
  Monitor& monitor_;

  scheduler::Executive executive_;
  scheduler::Line &safety_line_, &drive_line_, &receive_line_, &odometry_line_, &mapping_line_;
  SeenChannel seen_;
  DriveChannel drive_news_;
  OdometryChannel odometry_news_;
  DecisionChannel decisions_;
  ScanChannel scans_;
  MotionChannel motions_;
  Workers odometry_workers_, mapping_workers_;
  Robot robot_;
  SafetyTask safety_;
  DriveTask drive_;
  ReceiveTask receive_;
  OdometryTask odometry_;
  MappingTask mapping_;
  std::optional<TeamTasks> team_;
  IdleTask reference_;
  ToSave to_save_;
  ScheduleFaults schedule_faults_{executive_, safety_line_};
  bool best_effort_ = false;
  FailsafeDecision noted_;  // as far as note_changes() has read
};

}  // namespace cairn
