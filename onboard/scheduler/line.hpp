// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "hal/spsc_queue.hpp"
#include "onboard/scheduler/channel.hpp"
#include "onboard/scheduler/overrun.hpp"
#include "onboard/scheduler/progress.hpp"
#include "onboard/scheduler/releases.hpp"
#include "onboard/scheduler/schedule_log.hpp"
#include "onboard/scheduler/task_spec.hpp"
#include "onboard/scheduler/task_stats.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::scheduler {

/// One task and all that the executive keeps about it.
struct Line {
  explicit Line(TaskSpec s) : spec(std::move(s)), overrun(spec.soft(), spec.hard()) {}

  TaskSpec spec;
  Task* task = nullptr;            ///< set before the run; not owned
  bool input = false;              ///< it reads packets, and says when there are no more
  bool live_only = false;          ///< recording, saving, telling: nothing that a replay would repeat
  std::vector<ChannelBase*> from;  ///< channels that it takes from; not owned

  Progress progress;
  TaskStats stats;
  OverrunPolicy overrun;
  Releases releases;
  std::atomic<std::uint64_t> next{0};  ///< the release after the last tick that was served

  /// Live: ticks on their way to the log, from the task's thread to whoever writes it.
  SpscQueue<TickRecord> log{kLogged};
  RelaxedCounter unlogged;  ///< ticks that found `log` full: the run cannot be repeated
  static constexpr std::size_t kLogged = 8192;

  /// The release at which its input had ended; Time::max() before.
  [[nodiscard]] Time ended_at() const { return Time{Duration{ended_.load(std::memory_order_acquire)}}; }
  void end_at(const Tick& tick) {
    if (tick.ended() && ended_at() == Time::max())
      ended_.store(tick.release().time_since_epoch().count(), std::memory_order_release);
  }

  /// Logged: its ticks, and how far they have been repeated.
  const TaskLog* history = nullptr;
  std::size_t repeated = 0;
  /// Replay: the record of the tick that comes next: what the log says of it, or an idle one.
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
