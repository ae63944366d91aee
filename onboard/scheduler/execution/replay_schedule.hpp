// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "hal/clock.hpp"
#include "hal/result.hpp"
#include "onboard/scheduler/schedule_log.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::scheduler {

/// What a replay follows, at which pace, and for how long.
struct ReplayOptions {
  Time start{};                       ///< of virtual time: the first packet's arrival
  const ScheduleLog* log = nullptr;   ///< must outlive the run; null: virtual time decides
  const Clock* pace = nullptr;        ///< every task on a thread of its own, at real speed; null: as fast as possible
  Duration length = Duration::max();  ///< no release later than so long after the start
  std::function<bool()> stop{};  ///< asked before each tick, on its thread: whether the run ends there; empty: never
  /// Of the next packet of all inputs; Time::max(): none. With it, a replay in virtual time on one thread jumps over
  /// long silence (see Silence).
  std::function<Time()> next_arrival{};
};

/// How a replay went.
struct ReplayEnd {
  bool diverged = false;     ///< a tick of the log took more than there was: the recording is not that of the log
  bool interrupted = false;  ///< `stop` ended it before its last tick
  Duration jumped{};         ///< silence of the recording that virtual time jumped over
};

/// Which releases a replay has, and what each tick gets: from the log of a live run or, without one, from virtual time.
class ReplaySchedule {
 public:
  /// Sets the releases and the history of every task. Error kInvalidConfig: the log knows other tasks.
  static Result<ReplaySchedule> prepare(TaskGraph& graph, const ReplayOptions& options);

  [[nodiscard]] TaskGraph& graph() const { return *graph_; }
  [[nodiscard]] bool logged() const { return logged_; }
  /// Whether this release of the task is not served any more.
  [[nodiscard]] bool over(const ScheduledTask& task, Time release) const;
  /// Whether the run is to end before its last tick.
  [[nodiscard]] bool stopped() const { return stop_ && stop_(); }
  /// Whether every input has come so far.
  [[nodiscard]] bool inputs_reached(Time t) const;
  /// The next tick of the task. `gate`: of a replay on threads, which is opened. `clock`: at real speed, for figures.
  static void tick(ScheduledTask& task, Gate* gate, const Clock* clock);

 private:
  ReplaySchedule(TaskGraph& graph, Time last_release, bool logged, std::function<bool()> stop)
      : graph_(&graph), last_release_(last_release), logged_(logged), stop_(std::move(stop)) {}

  TaskGraph* graph_;
  Time last_release_;
  bool logged_;
  std::function<bool()> stop_;
};

}  // namespace cairn::scheduler
