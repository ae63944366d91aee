// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hal/relaxed_counter.hpp"
#include "onboard/app/tasks/recorder.hpp"
#include "onboard/scheduler/schedule_log.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {

/// Writes the schedule log and the recording, and runs the chores that were add()ed: everything that may wait for a
/// disk. On a thread of its own, live only.
class HousekeepingTask final : public scheduler::Task {
 public:
  /// `graph` must outlive the task; `recorder` too, or be null. The file of the log is made at once.
  HousekeepingTask(scheduler::TaskGraph& graph, const std::filesystem::path& schedule_log, Recorder* recorder)
      : graph_(graph), log_(schedule_log), recorder_(recorder) {}

  /// A chore is done in every tick, after those added before it.
  using Chore = std::function<void(Time now)>;
  void add(Chore chore) { chores_.push_back(std::move(chore)); }

  void tick(scheduler::Tick& tick) override;
  /// After the last tick of all tasks: writes what is still in the queues, and the ends of the log.
  Result<void> close(Time now);
  /// Any thread: the schedule log could not be written.
  [[nodiscard]] bool failing() const { return failures_ > 0; }

 private:
  void write_log();

  scheduler::TaskGraph& graph_;
  scheduler::ScheduleLogWriter log_;
  bool begun_ = false;
  RelaxedCounter failures_;
  Recorder* recorder_;
  std::vector<Chore> chores_;
};

}  // namespace cairn::app
