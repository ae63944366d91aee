// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <string_view>
#include <thread>

#include "hal/clock.hpp"
#include "hal/result.hpp"
#include "onboard/scheduler/line.hpp"
#include "onboard/scheduler/schedule_log.hpp"

namespace cairn::scheduler {

/// Releases the tasks of one robot at their rates: live on threads of their own, or again from a recording, when every
/// tick gets what the log of the live run says or, without one, what virtual time says. The tasks cannot tell which.
class Executive {
 public:
  /// Virtual time runs on for so long after the last packet; and no task of a replay runs further ahead of the inputs.
  static constexpr Duration kTail = std::chrono::milliseconds(30);

  /// Lines run in the order in which they are added when they are released together: producers before consumers. The
  /// reference stays valid as long as the executive. All tasks are set before a run.
  Line& add(TaskSpec spec) { return lines_.emplace_back(std::move(spec)); }
  [[nodiscard]] const std::deque<Line>& lines() const { return lines_; }
  [[nodiscard]] std::deque<Line>& lines() { return lines_; }

  /// Counts the allocations of the calling thread; without one, a line's figures say none.
  using CountAllocations = std::uint64_t (*)();
  void count_allocations(CountAllocations count) { allocations_ = count; }

  struct LiveOptions {
    Time start{};                  ///< release 0 of a task without phase
    std::function<bool()> stop{};  ///< asked about every 20 ms, on the calling thread
  };
  /// Returns after the last tick of every task and the final draining.
  void run_live(const LiveOptions& options, const Clock& clock);

  struct ReplayOptions {
    Time start{};                       ///< of virtual time: the first packet's arrival
    const ScheduleLog* log = nullptr;   ///< must outlive the run; null: virtual time decides
    const Clock* pace = nullptr;        ///< every task on a thread of its own, at real speed; null: as fast as possible
    Duration length = Duration::max();  ///< no release later than so long after the start
  };
  /// Error kInvalidConfig: the log knows other tasks.
  Result<void> run_replay(const ReplayOptions& options);
  /// The replay of a log came to a tick that took more than there was: the recording is not that of the log.
  [[nodiscard]] bool diverged() const { return diverged_; }

 private:
  struct Pace {
    const Clock* clock = nullptr;
    Duration offset{};  ///< machine time − robot time
  };
  Result<void> prepare(const ReplayOptions& options);
  void run_serial(const ReplayOptions& options);
  void run_threads(const ReplayOptions& options);
  void live_loop(Line& line, const Clock& clock);
  void replay_loop(Line& line, const Pace& pace);
  Line* next_line(bool only_ready);
  void replay_tick(Line& line, Gate* gate, const Clock* figures);
  void drain(const Clock* clock);
  [[nodiscard]] bool over(const Line& line, Time release) const;
  [[nodiscard]] bool inputs_reached(Time t) const;
  [[nodiscard]] Time stop_time() const;

  std::deque<Line> lines_;
  CountAllocations allocations_ = nullptr;
  bool diverged_ = false;
  Time last_release_ = Time::max();
  Gate gate_;
  std::atomic<bool> stop_{false};
};

}  // namespace cairn::scheduler
