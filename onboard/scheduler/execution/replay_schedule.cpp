// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/replay_schedule.hpp"

#include <algorithm>

#include "onboard/scheduler/execution/run_end.hpp"

namespace cairn::scheduler {
namespace {

/// False: the log knows no such task.
bool take_history(ScheduledTask& task, const ScheduleLog& log) {
  task.history = log.find(task.spec.name);
  if (task.history == nullptr || task.history->releases.period != task.releases.period) return false;
  task.releases = task.history->releases;
  return true;
}

}  // namespace

Result<ReplaySchedule> ReplaySchedule::prepare(TaskGraph& graph, const ReplayOptions& options) {
  for (ScheduledTask& task : graph.tasks()) {
    task.releases = {options.start + task.spec.phase(), task.spec.period()};
    task.next = 0;
    task.progress.reach(task.releases.first - Duration{1});
    if (options.log == nullptr || task.live_only()) continue;
    const bool known = take_history(task, *options.log);
    if (!known && (task.history != nullptr || task.role != TaskRole::kNewStage))
      return Error{Errc::kInvalidConfig,
                   "the schedule log is of another schedule",
                   task.spec.name,
                   {},
                   "replay with the profile of the live run (its config.yaml)"};
  }
  const bool bounded = options.length < Time::max() - options.start;
  const Time last = bounded ? options.start + options.length : Time::max();
  return ReplaySchedule(graph, last, options.log != nullptr, options.stop);
}

bool ReplaySchedule::over(const ScheduledTask& task, Time release) const {
  if (release > last_release_) return true;
  return task.history != nullptr ? task.next.load(std::memory_order_relaxed) >= task.history->end
                                 : release > stop_time(*graph_);
}

bool ReplaySchedule::inputs_reached(Time t) const {
  const auto& tasks = graph_->tasks();
  return std::all_of(tasks.begin(), tasks.end(),
                     [t](const ScheduledTask& task) { return !task.is_input() || task.progress.reached(t); });
}

void ReplaySchedule::tick(ScheduledTask& task, Gate* gate, const Clock* clock) {
  TickRecord record = task.due();
  if (task.history != nullptr && !record.idle()) ++task.repeated;
  const Time release = task.releases.at(record.index);
  Tick tick(task.history != nullptr ? Regime::kLogged : Regime::kVirtual, release, record, gate, clock);
  task.task.tick(tick);
  ++task.stats.ticks;
  task.end_at(tick);
  task.next = record.index + 1;
  task.progress.reach(task.releases.at(record.index + 1) - Duration{1});
  if (gate != nullptr) gate->open();
}

}  // namespace cairn::scheduler
