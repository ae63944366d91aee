// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "onboard/app/tasks/recorder.hpp"
#include "onboard/scheduler/executive.hpp"
#include "onboard/scheduler/schedule_log.hpp"

namespace cairn {

/// Everything that may wait for a disk, on a thread of its own: the schedule log and the recording, and whatever else
/// is add()ed gets its turn. Live only.
class HousekeepingTask final : public scheduler::Task {
 public:
  /// `executive` must outlive the task; `recorder` too, or be null. The log's file is made at once.
  HousekeepingTask(scheduler::Executive& executive, const std::filesystem::path& schedule_log, Recorder* recorder)
      : executive_(executive), log_(schedule_log), recorder_(recorder) {}

  /// A chore is done in every tick, after those added before it.
  using Chore = std::function<void(Time now)>;
  void add(Chore chore) { chores_.push_back(std::move(chore)); }

  void tick(scheduler::Tick& tick) override;
  /// After the last tick of all tasks: what is still in the queues, and the ends of the log.
  Result<void> close(Time now);

 private:
  void write_log();

  scheduler::Executive& executive_;
  scheduler::ScheduleLogWriter log_;
  bool begun_ = false;
  Recorder* recorder_;
  std::vector<Chore> chores_;
};

}  // namespace cairn
