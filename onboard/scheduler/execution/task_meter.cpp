// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/task_meter.hpp"

namespace cairn::scheduler {

TaskMeter::TaskMeter(ScheduledTask& task, const Clock& clock, CountAllocations allocations)
    : task_(task),
      clock_(clock),
      allocations_(allocations),
      usage_every_(static_cast<std::uint64_t>(task.spec.rate_hz) + 1) {}

void TaskMeter::begin() {
  start_ = clock_.now();
  cpu_ = thread_cpu_time();
  if (allocations_ != nullptr) allocated_ = allocations_();
}

std::uint64_t TaskMeter::end(Time release, bool busy) {
  const auto verdict = task_.overrun.tick(note_times(release), busy);
  note_overruns(verdict);
  note_usage(release);
  return verdict.skip;
}

/// Returns the execution time.
Duration TaskMeter::note_times(Time release) {
  const Time end = clock_.now();
  TaskStats& s = task_.stats;
  s.wake.record(start_ - release);
  s.response.record(end - release);
  s.execution.record(end - start_);
  s.cpu.record(thread_cpu_time() - cpu_);
  if (end - release > task_.spec.deadline()) ++s.misses;
  if (warm(release) && allocations_ != nullptr) s.allocations += allocations_() - allocated_;
  return end - start_;
}

void TaskMeter::note_overruns(const OverrunPolicy::Verdict& verdict) {
  TaskStats& s = task_.stats;
  if (verdict.soft) ++s.soft_overruns;
  if (verdict.hard) ++s.hard_overruns;
  if (verdict.newly_demoted) ++s.demotions;
  s.demoted = task_.overrun.demoted() ? 1 : 0;
}

void TaskMeter::note_usage(Time release) {
  if (!warm(release)) return;
  const std::uint64_t ticks_before = task_.stats.warm_ticks;
  ++task_.stats.warm_ticks;
  if (ticks_before % usage_every_ != 0) return;
  const ThreadUsage now = thread_usage();
  if (!usage_known_) usage_at_warm_up_ = now;
  usage_known_ = true;
  task_.stats.major_faults = now.major_faults - usage_at_warm_up_.major_faults;
  task_.stats.minor_faults = now.minor_faults - usage_at_warm_up_.minor_faults;
  task_.stats.involuntary_switches = now.involuntary_switches - usage_at_warm_up_.involuntary_switches;
}

}  // namespace cairn::scheduler
