// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>

#include "hal/clock.hpp"
#include "onboard/scheduler/execution/task_meter.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::scheduler {

/// When a live run begins, and when it ends.
struct LiveOptions {
  Time start{};                  ///< release 0 of a task without phase
  std::function<bool()> stop{};  ///< asked about every 20 ms, on the calling thread
};

/// Runs every task on a thread of its own, on the machine's clock, until `stop` says so or all inputs have ended.
/// Returns after the last tick of every task; nothing is drained.
void run_live(TaskGraph& graph, const LiveOptions& options, const Clock& clock, CountAllocations allocations);

/// Releases one task on the calling thread until `stop`. Releases that are passed by a late tick are skipped.
void run_task_live(ScheduledTask& task, const Clock& clock, CountAllocations allocations,
                   const std::atomic<bool>& stop);

}  // namespace cairn::scheduler
