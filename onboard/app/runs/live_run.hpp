// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "hal/clock.hpp"
#include "onboard/app/perception/box_recorder.hpp"
#include "onboard/app/perception/label_recorder.hpp"
#include "onboard/app/runs/run_context.hpp"
#include "onboard/app/runs/safety_events.hpp"
#include "onboard/app/runs/schedule_faults.hpp"
#include "onboard/app/runs/status_publisher.hpp"
#include "onboard/app/streams/streams_task.hpp"
#include "onboard/app/tasks/housekeeping_task.hpp"
#include "onboard/app/tasks/recorder.hpp"
#include "onboard/app/tasks/robot_tasks.hpp"
#include "onboard/app/tasks/saving_task.hpp"
#include "onboard/app/tasks/watch_task.hpp"

namespace cairn::app {

/// Runs the tasks of a robot on the machine's clock, beside those that only a live run has: housekeeping, saving,
/// watching and serving clients.
class LiveRun {
 public:
  /// All must outlive the run; the run must outlive the use of `tasks`.
  LiveRun(RobotTasks& tasks, const RunContext& context, const Clock& clock);

  /// Until the options' `stop`, their seconds are over, or a played recording has ended. Leaves schedule.log and, where
  /// it is asked for, a recording. A stop is an interruption only while a recording is played. `generations`: where the
  /// map is saved; null: nowhere. Errors: an input cannot be connected; a socket cannot be served; the recording cannot
  /// be begun. A disk that fails later is an event.
  Result<RunEnd> run(Generations* generations);
  /// After run(): why schedule.log is not complete; none: it is.
  [[nodiscard]] const std::optional<Error>& lost_schedule() const { return lost_schedule_; }

 private:
  Result<void> open_recorder();
  Result<void> keep_labels(const std::filesystem::path& folder);
  Result<void> keep_boxes(const std::filesystem::path& folder);
  Result<void> open_streams();
  void show_thermal();
  void add_live_only_tasks(Generations* generations);
  [[nodiscard]] safety::Pulse add_saving(Generations& generations);
  scheduler::ScheduledTask& add_live_only(const scheduler::TaskSpec& spec, scheduler::Task& task);
  void execute();
  /// When the last packet of the played recording was used; Time::max(): it goes on, or none is played.
  [[nodiscard]] Time played_until() const;
  [[nodiscard]] bool played_out(Time now) const;
  [[nodiscard]] RunEnd end() const;
  void publish_status(Time now);
  void publish_people();
  void publish_state();
  void close_streams();
  void close_log();
  [[nodiscard]] safety::FaultSet faults_of_machine() const;
  void report_unlogged_ticks();

  RobotTasks& tasks_;
  RunContext context_;
  const Clock& clock_;
  SafetyEvents safety_events_;
  ScheduleFaults schedule_faults_;
  ToSave to_save_;
  std::optional<Recorder> recorder_;
  std::unique_ptr<BoxRecorder> boxes_;     // null: nobody looks for people, or not recorded
  std::unique_ptr<LabelRecorder> labels_;  // null: nothing is labelled, or not recorded
  std::optional<HousekeepingTask> housekeeping_;
  std::optional<SavingTask> saving_;
  std::optional<WatchTask> watch_;
  std::optional<StatusPublisher> publisher_;
  std::optional<StreamOutlets> outlets_;
  std::optional<StreamsTask> streams_;
  bool best_effort_ = false;
  std::optional<Error> lost_schedule_;
};

}  // namespace cairn::app
