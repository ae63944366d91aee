// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.hpp"
#include "hal/histogram.hpp"
#include "hal/time.hpp"

namespace cairn {

/// Something that happened and that the operator should know; equal (stage, what) pairs are counted, not repeated.
struct Event {
  Time first{}, last{};
  std::string stage;
  std::string what;
  std::uint64_t count = 0;
};

/// What one stage cost.
struct StageStats {
  std::string name;
  Duration budget{};        ///< zero: none declared
  RelaxedCounter overruns;  ///< wall time above the budget
  Histogram wall;           ///< elapsed time
  Histogram cpu;            ///< CPU time of the calling thread

  /// Counts one call that took `elapsed`, and compares it with the budget.
  void record(Duration elapsed);
};

/// Keeps the figures and events of a run. Callees report here; policy is decided by whoever owns the monitor. Any
/// thread may call stage() and event(), which lock and allocate: real-time threads hold on to their stages and say
/// nothing else.
class Monitor {
 public:
  /// The stage's figures, made on first use. `budget` counts then only; a stage may be declared before its user asks.
  /// The reference stays valid as long as the monitor. One thread records.
  StageStats& stage(std::string_view name, Duration budget = {});
  /// At most kMaxEvents kinds are kept; further kinds are counted in dropped_events().
  void event(Time when, std::string_view stage, std::string_view what);

  /// Of a run that has ended: nobody may report meanwhile.
  [[nodiscard]] const std::deque<StageStats>& stages() const { return stages_; }
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }
  [[nodiscard]] std::uint64_t dropped_events() const { return dropped_events_; }
  /// A copy, while others report.
  [[nodiscard]] std::vector<Event> events_now() const;
  /// Any thread, without a lock: counts the events that were kept. A copy is worth its time only when this has changed.
  [[nodiscard]] std::uint64_t kept_events() const { return kept_events_.load(std::memory_order_acquire); }

  static constexpr std::size_t kMaxEvents = 256;

 private:
  mutable std::mutex mutex_;  // of the two lists, not of a stage's figures
  std::deque<StageStats> stages_;
  std::vector<Event> events_;
  std::uint64_t dropped_events_ = 0;
  std::atomic<std::uint64_t> kept_events_{0};
};

/// Times a scope: `const StageTimer timing{monitor.stage("odometry")};`. Figures only; no result depends on it.
class StageTimer {
 public:
  explicit StageTimer(StageStats& stage) : stage_(stage), wall_(LiveClock{}.now()), cpu_(thread_cpu_time()) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer();

 private:
  StageStats& stage_;
  Time wall_;
  Duration cpu_;
};

}  // namespace cairn
