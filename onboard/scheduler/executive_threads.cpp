// SPDX-License-Identifier: Apache-2.0
// The executive's two ways of running every task on a thread of its own.
#include "onboard/scheduler/executive.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn::scheduler {
namespace {

// Until then buffers grow and pages are touched for the first time.
constexpr Duration kWarmUp = std::chrono::seconds(2);
constexpr Duration kLook = std::chrono::milliseconds(20);

ThreadPlan plan_of(const TaskSpec& spec) { return {spec.name, spec.priority, spec.core}; }

/// Measures one tick. What it finds goes to the line's figures and never into a result.
class Measured {
 public:
  Measured(Line& line, const Clock& clock, Executive::CountAllocations allocations)
      : line_(line), clock_(clock), allocations_(allocations), start_(clock.now()), cpu_(thread_cpu_time()) {
    if (allocations_ != nullptr) allocated_ = allocations_();
  }

  /// Returns the execution time.
  Duration end(Time release) {
    const Time end = clock_.now();
    TaskStats& s = line_.stats;
    s.wake.record(start_ - release);
    s.response.record(end - release);
    s.execution.record(end - start_);
    s.cpu.record(thread_cpu_time() - cpu_);
    if (end - release > line_.spec.deadline()) ++s.misses;
    if (release - line_.releases.first > kWarmUp && allocations_ != nullptr)
      s.allocations += allocations_() - allocated_;
    return end - start_;
  }

 private:
  Line& line_;
  const Clock& clock_;
  Executive::CountAllocations allocations_;
  Time start_;
  Duration cpu_;
  std::uint64_t allocated_ = 0;
};

/// The thread's page faults and switches since the warm-up, about once a second.
class UsageWatch {
 public:
  explicit UsageWatch(Line& line) : line_(line), every_(static_cast<std::uint64_t>(line.spec.rate_hz) + 1) {}

  void tick(Time release) {
    if (release - line_.releases.first <= kWarmUp || ticks_++ % every_ != 0) return;
    const ThreadUsage now = thread_usage();
    if (!warm_) first_ = now;
    warm_ = true;
    line_.stats.major_faults = now.major_faults - first_.major_faults;
    line_.stats.minor_faults = now.minor_faults - first_.minor_faults;
    line_.stats.involuntary_switches = now.involuntary_switches - first_.involuntary_switches;
  }

 private:
  Line& line_;
  std::uint64_t every_, ticks_ = 0;
  bool warm_ = false;
  ThreadUsage first_;
};

void note(Line& line, const OverrunPolicy::Verdict& v) {
  if (v.soft) ++line.stats.soft_overruns;
  if (v.hard) ++line.stats.hard_overruns;
  if (v.newly_demoted) ++line.stats.demotions;
  line.stats.demoted = line.overrun.demoted() ? 1 : 0;
}

void hand_to_log(Line& line, const TickRecord& record) {
  if (record.idle()) return;
  if (TickRecord* slot = line.log.back()) {
    *slot = record;
    line.log.push();
  } else {
    ++line.unlogged;
  }
}

}  // namespace

void Executive::live_loop(Line& line, const Clock& clock) {
  UsageWatch usage(line);
  std::uint64_t k = line.releases.not_before(clock.now());
  std::uint64_t expected = 0;
  line.stats.slips += k;  // the thread began late
  for (;;) {
    const Time release = line.releases.at(k);
    LiveClock::wait_until(release);
    if (stop_.load(std::memory_order_relaxed)) break;
    TickRecord record;
    record.index = k;
    record.skipped = static_cast<std::uint32_t>(k - expected);
    Measured measured(line, clock, allocations_);
    Tick tick(Regime::kLive, release, record, nullptr, &clock);
    line.task->tick(tick);
    const auto verdict = line.overrun.tick(measured.end(release), !record.idle());
    ++line.stats.ticks;
    note(line, verdict);
    usage.tick(release);
    hand_to_log(line, record);
    line.end_at(tick);
    expected = k + 1;
    line.next = expected;
    k = line.releases.after(k, clock.now());
    line.stats.slips += k - expected;
    k += verdict.skip;
  }
}

void Executive::run_live(const LiveOptions& options, const Clock& clock) {
  std::vector<std::thread> threads;
  stop_ = false;
  for (Line& line : lines_) line.releases = {options.start + line.spec.phase(), line.spec.period()};
  for (Line& line : lines_)
    threads.push_back(start_thread(plan_of(line.spec), [this, &line, &clock] { live_loop(line, clock); }));
  for (Time t = clock.now(); !options.stop() && clock.now() < stop_time(); t += kLook) LiveClock::wait_until(t + kLook);
  stop_ = true;
  for (std::thread& t : threads) t.join();
  drain(&clock);
}

void Executive::replay_loop(Line& line, const Pace& pace) {
  class RobotClock final : public Clock {  // the machine's clock, on the recording's time line
   public:
    explicit RobotClock(const Pace& pace) : pace_(pace) {}
    [[nodiscard]] Time now() const override { return pace_.clock->now() - pace_.offset; }

   private:
    const Pace& pace_;
  };
  const RobotClock clock(pace);
  UsageWatch usage(line);
  for (;;) {
    const Time release = line.releases.at(line.due().index);
    gate_.wait_until([&] { return inputs_reached(release - kTail) || line.history != nullptr; });
    if (over(line, release)) break;
    LiveClock::wait_until(release + pace.offset);
    Measured measured(line, clock, allocations_);
    replay_tick(line, &gate_, &clock);
    note(line, line.overrun.tick(measured.end(release), true));
    usage.tick(release);
  }
  line.progress.finish();
  gate_.open();
}

void Executive::run_threads(const ReplayOptions& options) {
  const Pace pace{options.pace, options.pace->now() - options.start};
  std::vector<std::thread> threads, beside;
  stop_ = false;
  for (Line& line : lines_) {
    if (line.live_only) {
      line.releases = {options.pace->now() + line.spec.phase(), line.spec.period()};
      beside.push_back(start_thread(plan_of(line.spec), [this, &line, &pace] { live_loop(line, *pace.clock); }));
    } else {
      threads.push_back(start_thread(plan_of(line.spec), [this, &line, &pace] { replay_loop(line, pace); }));
    }
  }
  for (std::thread& t : threads) t.join();
  stop_ = true;
  for (std::thread& t : beside) t.join();
}

}  // namespace cairn::scheduler
