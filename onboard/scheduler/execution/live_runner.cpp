// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/live_runner.hpp"

#include "onboard/scheduler/execution/run_end.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn::scheduler {
namespace {

constexpr Duration kStopCheckPeriod = std::chrono::milliseconds(20);

void hand_to_log(ScheduledTask& task, const TickRecord& record) {
  if (record.idle()) return;
  if (TickRecord* place = task.log.back()) {
    *place = record;
    task.log.push();
  } else {
    ++task.unlogged;
  }
}

}  // namespace

void run_task_live(ScheduledTask& task, const Clock& clock, CountAllocations allocations,
                   const std::atomic<bool>& stop) {
  TaskMeter meter(task, clock, allocations);
  std::uint64_t k = task.releases.not_before(clock.now());
  std::uint64_t expected = 0, slipped = k;  // at first: the thread began late
  for (;;) {
    const Time release = task.releases.at(k);
    LiveClock::wait_until(release);
    if (stop.load(std::memory_order_relaxed)) break;
    task.stats.slips += slipped;  // not before: the run may end first
    TickRecord record;
    record.index = k;
    record.skipped = static_cast<std::uint32_t>(k - expected);
    meter.begin();
    Tick tick(Regime::kLive, release, record, nullptr, &clock);
    task.task.tick(tick);
    const std::uint64_t skip = meter.end(release, !record.idle());
    ++task.stats.ticks;
    hand_to_log(task, record);
    task.end_at(tick);
    expected = k + 1;
    task.next = expected;
    k = task.releases.after(k, clock.now());
    slipped = k - expected;
    k += skip;
  }
}

void run_live(TaskGraph& graph, const LiveOptions& options, const Clock& clock, CountAllocations allocations) {
  std::atomic<bool> stop{false};
  ThreadGroup threads;
  for (ScheduledTask& task : graph.tasks()) task.releases = {options.start + task.spec.phase(), task.spec.period()};
  for (ScheduledTask& task : graph.tasks())
    threads.start(plan_of(task.spec), [&] { run_task_live(task, clock, allocations, stop); });
  for (Time t = clock.now(); !options.stop() && clock.now() < stop_time(graph); t += kStopCheckPeriod)
    LiveClock::wait_until(t + kStopCheckPeriod);
  stop = true;
  threads.join();
}

}  // namespace cairn::scheduler
