// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <utility>
#include <vector>

#include "hal/spsc_queue.hpp"
#include "onboard/scheduler/overrun.hpp"
#include "onboard/scheduler/ports.hpp"
#include "onboard/scheduler/progress.hpp"
#include "onboard/scheduler/releases.hpp"
#include "onboard/scheduler/schedule_log.hpp"
#include "onboard/scheduler/task_spec.hpp"
#include "onboard/scheduler/task_stats.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::scheduler {

/// What the executive must know of a task besides its spec.
enum class TaskRole : std::uint8_t {
  kStage,     ///< computes from what its input ports give it
  kInput,     ///< reads packets, and says when there are no more
  kLiveOnly,  ///< recording, saving, publishing: a replay leaves it out
  kNewStage,  ///< a stage that earlier versions lacked: it idles in the replay of a log that does not know it
};

/// One task and all that the executive keeps about it.
struct ScheduledTask {
  /// `t` must outlive it.
  ScheduledTask(TaskSpec s, Task& t, TaskRole r)
      : spec(std::move(s)), task(t), role(r), overrun(spec.soft(), spec.hard()) {}

  TaskSpec spec;
  Task& task;
  TaskRole role;
  std::vector<const InputPortBase*> inputs;  ///< that are connected; the task's own

  Progress progress;
  TaskStats stats;
  OverrunPolicy overrun;
  Releases releases;
  std::atomic<std::uint64_t> next{0};  ///< the release after the last tick that was served

  /// Live: ticks on their way to the log, from the task's thread to the housekeeping task.
  SpscQueue<TickRecord> log{kLogged};
  RelaxedCounter unlogged;                      ///< ticks that found `log` full: the run cannot be repeated
  static constexpr std::size_t kLogged = 8192;  ///< ticks: 16 s of the fastest task

  [[nodiscard]] bool is_input() const { return role == TaskRole::kInput; }
  [[nodiscard]] bool live_only() const { return role == TaskRole::kLiveOnly; }

  /// The release at which its input had ended; Time::max() before.
  [[nodiscard]] Time ended_at() const { return Time{Duration{ended_.load(std::memory_order_acquire)}}; }
  void end_at(const Tick& tick) {
    if (tick.ended() && ended_at() == Time::max())
      ended_.store(tick.release().time_since_epoch().count(), std::memory_order_release);
  }

  /// Logged: its ticks, and how far they have been repeated.
  const TaskLog* history = nullptr;
  std::size_t repeated = 0;
  /// Replay: the record of the next tick, from the log or idle.
  [[nodiscard]] TickRecord due() const {
    const std::uint64_t k = next.load(std::memory_order_relaxed);
    if (history != nullptr && repeated < history->ticks.size()) {
      const TickRecord& logged = history->ticks[repeated];
      if (logged.index - logged.skipped == k) return logged;
    }
    TickRecord idle;
    idle.index = k;
    return idle;
  }

 private:
  std::atomic<Time::rep> ended_{Time::max().time_since_epoch().count()};
};

}  // namespace cairn::scheduler
