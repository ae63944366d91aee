// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/clock.hpp"
#include "onboard/scheduler/scheduled_task.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn::scheduler {

/// The allocations of the calling thread so far.
using CountAllocations = std::uint64_t (*)();

/// Measures the ticks of one task, on the task's thread. Everything goes to the task's figures and never into a
/// result. Until the warm-up is over, buffers grow and pages are touched for the first time: allocations and page
/// faults are not counted.
class TaskMeter {
 public:
  static constexpr Duration kWarmUp = std::chrono::seconds(2);

  /// `task` and `clock` must outlive the meter. `allocations` may be null: none are counted.
  TaskMeter(ScheduledTask& task, const Clock& clock, CountAllocations allocations);

  /// Before the tick.
  void begin();
  /// After the tick of this release. `busy`: it had work. Returns how many releases to leave out.
  std::uint64_t end(Time release, bool busy);

 private:
  Duration note_times(Time release);
  void note_overruns(const OverrunPolicy::Verdict& verdict);
  void note_usage(Time release);
  [[nodiscard]] bool warm(Time release) const { return release - task_.releases.first > kWarmUp; }

  ScheduledTask& task_;
  const Clock& clock_;
  CountAllocations allocations_;
  // Of the tick that runs.
  Time start_{};
  Duration cpu_{};
  std::uint64_t allocated_ = 0;
  // Page faults and switches are read about once a second.
  std::uint64_t usage_every_;
  bool usage_known_ = false;
  ThreadUsage usage_at_warm_up_;
};

}  // namespace cairn::scheduler
