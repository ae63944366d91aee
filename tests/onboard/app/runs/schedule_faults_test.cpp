// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/schedule_faults.hpp"

#include <gtest/gtest.h>

#include "onboard/scheduler/execution/executive.hpp"
#include "onboard/scheduler/idle_task.hpp"

namespace cairn {
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
  EXPECT_EQ(faults.look(), FaultSet{});
  ++other.stats.misses;
  EXPECT_EQ(faults.look(), FaultSet{}) << "of another task";
  ++safety.stats.misses;
  EXPECT_EQ(faults.look(), FaultSet{Fault::kSafetyMissed});
  EXPECT_EQ(faults.look(), FaultSet{});
}

TEST(ScheduleFaults, WhatIsNoPartOfTheRobotIsLeftOut) {
  scheduler::IdleTask idle;
  TaskGraph graph;
  ScheduledTask& safety = graph.add(spec("safety", 0), idle);
  ScheduledTask& housekeeping = graph.add(spec("housekeeping", 0), idle, scheduler::TaskRole::kLiveOnly);
  housekeeping.stats.demoted = 1;
  EXPECT_EQ(ScheduleFaults(graph, safety).look(), FaultSet{});
}

/// Needs more than its hard budget in its first ticks, and nothing afterwards.
class Glutton final : public scheduler::Task {
 public:
  explicit Glutton(Duration takes) : takes_(takes) {}
  void tick(Tick& tick) override {
    tick.slot(0) = 1;  // it had work
    const LiveClock clock;
    const Time end = clock.now() + takes_;
    while (full && clock.now() < end) {
    }
  }
  std::atomic<bool> full{true};

 private:
  Duration takes_;
};

TEST(ScheduleFaults, AStageThatKeepsOverrunningIsDemotedWhileItDoes) {
  constexpr double kHardMs = 20;  // a machine with other work to do takes no tenth tick for so long
  Glutton nothing(0ms), glutton(21ms);
  TaskGraph graph;
  const ScheduledTask& safety = graph.add(spec("safety", 0), nothing);
  const ScheduledTask& greedy = graph.add(spec("glutton", kHardMs), glutton);
  ScheduleFaults faults(graph, safety);
  const LiveClock clock;
  bool demoted = false;
  const auto over = [&] {
    const bool now = faults.look().has(Fault::kStageDemoted);
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
}  // namespace cairn
