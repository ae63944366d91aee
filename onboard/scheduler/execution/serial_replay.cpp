// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/serial_replay.hpp"

#include <algorithm>

namespace cairn::scheduler {
namespace {

/// The task that is released next and can run; null when all are over. What a live tick took may have come from a tick
/// that was released later but ran earlier. Then that one comes first here, too: `only_ready`.
ScheduledTask* next_task(const ReplaySchedule& schedule, bool only_ready) {
  ScheduledTask* best = nullptr;
  Time best_release = Time::max();
  for (ScheduledTask& task : schedule.graph().tasks()) {
    if (task.live_only()) continue;
    const TickRecord record = task.due();
    const Time release = task.releases.at(record.index);
    if (schedule.over(task, release) || (best != nullptr && release >= best_release)) continue;
    const auto holds = [&](const InputPortBase* port) { return port->holds(record); };
    if (only_ready && !std::all_of(task.inputs.begin(), task.inputs.end(), holds)) continue;
    best = &task;
    best_release = release;
  }
  return best;
}

}  // namespace

ReplayEnd replay_serially(const ReplaySchedule& schedule, Silence* silence) {
  ReplayEnd end;
  for (;;) {
    ScheduledTask* task = next_task(schedule, schedule.logged());
    if (task == nullptr && schedule.logged()) {
      // None has what it took then. Going on shows how much is missing; stopping would hide it.
      task = next_task(schedule, false);
      end.diverged = end.diverged || task != nullptr;
    }
    end.interrupted = task != nullptr && schedule.stopped();
    if (task == nullptr || end.interrupted) return end;
    const bool jumps = silence != nullptr && !schedule.logged();
    if (jumps && silence->pass(task->releases.at(task->due().index))) continue;
    ReplaySchedule::tick(*task, nullptr, nullptr);
  }
}

}  // namespace cairn::scheduler
