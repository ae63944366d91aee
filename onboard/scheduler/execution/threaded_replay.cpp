// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/threaded_replay.hpp"

#include <algorithm>
#include <atomic>

#include "onboard/scheduler/execution/live_runner.hpp"
#include "onboard/scheduler/execution/run_end.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn::scheduler {
namespace {

/// The machine's clock, on the time line of the recording.
class RobotClock final : public Clock {
 public:
  /// `offset`: machine time − robot time.
  RobotClock(const Clock& machine, Duration offset) : machine_(machine), offset_(offset) {}
  [[nodiscard]] Time now() const override { return machine_.now() - offset_; }
  /// Asks `stopped` now and then. True: the time has come.
  template <class Stopped>
  [[nodiscard]] bool wait_until(Time t, Stopped stopped) const {
    constexpr Duration kAskEvery = std::chrono::milliseconds(20);
    while (!stopped()) {
      const Time next = now() + kAskEvery;
      LiveClock::wait_until(std::min(t, next) + offset_);
      if (t <= next) return true;
    }
    return false;
  }

 private:
  const Clock& machine_;
  Duration offset_;
};

void replay_task(ScheduledTask& task, const ReplaySchedule& schedule, Gate& gate, const RobotClock& clock,
                 CountAllocations allocations, std::atomic<bool>& interrupted) {
  TaskMeter meter(task, clock, allocations);
  const auto stopped = [&] {
    if (schedule.stopped()) interrupted = true;  // for all tasks: those that wait for this one would wait for ever
    return interrupted.load(std::memory_order_relaxed);
  };
  for (;;) {
    const Time release = task.releases.at(task.due().index);
    gate.wait_until([&] { return schedule.inputs_reached(release - kTail) || task.history != nullptr; });
    if (schedule.over(task, release) || !clock.wait_until(release, stopped)) break;
    meter.begin();
    ReplaySchedule::tick(task, &gate, &clock);
    (void)meter.end(release, true);  // a replay skips what the log skipped, and nothing else
  }
  task.progress.finish();
  gate.open();
}

}  // namespace

ReplayEnd replay_on_threads(const ReplaySchedule& schedule, Time start, const Clock& clock,
                            CountAllocations allocations) {
  const Time begun = clock.now();
  const RobotClock robot_clock(clock, begun - start);
  Gate gate;
  std::atomic<bool> stop{false}, interrupted{false};
  ThreadGroup replayed, beside;
  for (ScheduledTask& task : schedule.graph().tasks()) {
    if (task.live_only()) {
      task.releases = {clock.now() + task.spec.phase(), task.spec.period()};
      beside.start(plan_of(task.spec), [&] { run_task_live(task, clock, allocations, stop); });
    } else {
      replayed.start(plan_of(task.spec),
                     [&] { replay_task(task, schedule, gate, robot_clock, allocations, interrupted); });
    }
  }
  replayed.join();
  stop = true;
  beside.join();
  return {.interrupted = interrupted};
}

}  // namespace cairn::scheduler
