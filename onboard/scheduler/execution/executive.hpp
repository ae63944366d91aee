// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/clock.hpp"
#include "hal/result.hpp"
#include "onboard/scheduler/execution/live_runner.hpp"
#include "onboard/scheduler/execution/replay_schedule.hpp"
#include "onboard/scheduler/execution/task_meter.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::scheduler {

/// Releases the tasks of one robot at their rates: live on threads of their own, or again from a recording. In a replay
/// every tick gets what the log of the live run says or, without a log, what virtual time says. The tasks cannot tell
/// which.
class Executive {
 public:
  /// `graph` must outlive the executive. `allocations` counts those of the calling thread; without it, none are
  /// counted.
  explicit Executive(TaskGraph& graph, CountAllocations allocations = nullptr)
      : graph_(graph), allocations_(allocations) {}

  /// Returns after the last tick of every task and the final draining.
  void run_live(const LiveOptions& options, const Clock& clock);
  /// Error kInvalidConfig: the log knows other tasks.
  Result<ReplayEnd> run_replay(const ReplayOptions& options);

 private:
  TaskGraph& graph_;
  CountAllocations allocations_;
};

}  // namespace cairn::scheduler
