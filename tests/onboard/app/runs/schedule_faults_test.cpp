// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/schedule_faults.hpp"

#include <gtest/gtest.h>

#include "onboard/scheduler/execution/executive.hpp"
#include "onboard/scheduler/idle_task.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;
using scheduler::Executive;
using scheduler::ScheduledTask;
using scheduler::TaskGraph;
using scheduler::TaskSpec;
using scheduler::Tick;

TaskSpec spec(const char* name, double hard_ms) { return {.name = name, .rate_hz = 500, .hard_ms = hard_ms}; }

TEST(ScheduleFaults, AMissOfTheSafetyTaskIsAFaultUntilTheNextLook) {
  scheduler::IdleTask idle;
  TaskGraph graph;
  ScheduledTask& safety = graph.add(spec("safety", 0), idle);
  ScheduledTask& other = graph.add(spec("other", 0), idle);
  ScheduleFaults faults(graph, safety);
  EXPECT_EQ(faults.look(), safety::FaultSet{});
  ++other.stats.misses;
  EXPECT_EQ(faults.look(), safety::FaultSet{}) << "of another task";
  ++safety.stats.misses;
  EXPECT_EQ(faults.look(), safety::FaultSet{safety::Fault::kSafetyMissed});
  EXPECT_EQ(faults.look(), safety::FaultSet{});
}

TEST(ScheduleFaults, WhatIsNoPartOfTheRobotIsLeftOut) {
  scheduler::IdleTask idle;
  TaskGraph graph;
  ScheduledTask& safety = graph.add(spec("safety", 0), idle);
  ScheduledTask& housekeeping = graph.add(spec("housekeeping", 0), idle, scheduler::TaskRole::kLiveOnly);
  housekeeping.stats.demoted = 1;
  EXPECT_EQ(ScheduleFaults(graph, safety).look(), safety::FaultSet{});
}

/// Time that passes only where a task takes it: what else the machine does costs none.
class WorkClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return Time{Duration{now_.load()}}; }
  void take(Duration d) { now_ += d.count(); }

 private:
  std::atomic<Duration::rep> now_{0};
};

/// Needs more than its hard budget in its first ticks, and nothing afterwards.
class Glutton final : public scheduler::Task {
 public:
  Glutton(Duration takes, WorkClock& clock) : takes_(takes), clock_(clock) {}
  void tick(Tick& tick) override {
    tick.slot(0) = 1;  // it had work
    if (full) clock_.take(takes_);
  }
  std::atomic<bool> full{true};

 private:
  Duration takes_;
  WorkClock& clock_;
};

TEST(ScheduleFaults, AStageThatKeepsOverrunningIsDemotedWhileItDoes) {
  WorkClock clock;
  Glutton nothing(0ms, clock), glutton(21ms, clock);
  TaskGraph graph;
  const ScheduledTask& safety = graph.add(spec("safety", 0), nothing);
  const ScheduledTask& greedy = graph.add(spec("glutton", 20), glutton);
  ScheduleFaults faults(graph, safety);
  bool demoted = false;
  const auto over = [&] {
    const bool now = faults.look().has(safety::Fault::kStageDemoted);
    demoted = demoted || now;
    if (demoted) glutton.full = false;
    return demoted && !now;
  };
  Executive(graph).run_live({clock.now(), over}, clock);
  EXPECT_TRUE(demoted);
  EXPECT_GE(greedy.stats.hard_overruns, 3U);
  EXPECT_EQ(greedy.stats.demotions, 1U);
}

}  // namespace
}  // namespace cairn::app
