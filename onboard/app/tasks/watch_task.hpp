// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "onboard/app/tasks/recorder.hpp"
#include "onboard/safety/fault.hpp"
#include "onboard/safety/health.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::app {

/// Watches the other tasks and runs the chores that were add()ed. Chores may lock and allocate, but wait for no disk.
/// Live only, on a thread of its own: a slow disk must not look like a core that hangs.
class WatchTask final : public scheduler::Task {
 public:
  /// A task that writes a little at a time, and does not come back for so long, waits for the disk.
  static constexpr Duration kDiskLimit = std::chrono::milliseconds(500);
  using Chore = std::function<void(Time now)>;

  /// `writers`: the tasks that wait for disks, each with its limit. `recorder` must outlive the task; may be null.
  WatchTask(std::vector<safety::Pulse> writers, const Recorder* recorder)
      : disk_(std::move(writers)), recorder_(recorder) {}

  /// A chore is done in every tick, after those added before it.
  void add(Chore chore) { chores_.push_back(std::move(chore)); }

  void tick(scheduler::Tick& tick) override {
    faults_.set(safety::Fault::kDiskFailing,
                disk_.step(tick.release()).has_value() || (recorder_ != nullptr && recorder_->failed()));
    for (const Chore& chore : chores_) chore(tick.release());
  }
  /// Of the task's thread: the faults that this task found itself.
  [[nodiscard]] safety::FaultSet faults() const { return faults_; }

 private:
  safety::Supervisor disk_;
  const Recorder* recorder_;
  safety::FaultSet faults_;
  std::vector<Chore> chores_;
};

}  // namespace cairn::app
