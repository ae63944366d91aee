// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/schedule_faults.hpp"

#include <gtest/gtest.h>

namespace cairn {
namespace {

using namespace std::chrono_literals;
using scheduler::Executive;
using scheduler::Line;
using scheduler::TaskSpec;
using scheduler::Tick;

TaskSpec spec(const char* name, double hard_ms) {
  TaskSpec s;
  s.name = name;
  s.rate_hz = 500;
  s.hard_ms = hard_ms;
  return s;
}

TEST(ScheduleFaults, AMissOfTheSafetyTaskIsAFaultUntilTheNextLook) {
  Executive executive;
  Line& safety = executive.add(spec("safety", 0));
  Line& other = executive.add(spec("other", 0));
  ScheduleFaults faults(executive, safety);
  EXPECT_EQ(faults.look(), FaultSet{});
  ++other.stats.misses;
  EXPECT_EQ(faults.look(), FaultSet{}) << "of another task";
  ++safety.stats.misses;
  EXPECT_EQ(faults.look(), FaultSet{Fault::kSafetyMissed});
  EXPECT_EQ(faults.look(), FaultSet{});
}

TEST(ScheduleFaults, WhatIsNoPartOfTheRobotIsLeftOut) {
  Executive executive;
  Line& safety = executive.add(spec("safety", 0));
  Line& housekeeping = executive.add(spec("housekeeping", 0));
  housekeeping.live_only = true;
  housekeeping.stats.demoted = 1;
  EXPECT_EQ(ScheduleFaults(executive, safety).look(), FaultSet{});
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
  Executive executive;
  Line& safety = executive.add(spec("safety", 0));
  Line& line = executive.add(spec("glutton", 20));
  WorkClock clock;
  Glutton nothing(0ms, clock), glutton(21ms, clock);
  safety.task = &nothing;
  line.task = &glutton;
  ScheduleFaults faults(executive, safety);
  bool demoted = false;
  const auto over = [&] {
    const bool now = faults.look().has(Fault::kStageDemoted);
    demoted = demoted || now;
    if (demoted) glutton.full = false;
    return demoted && !now;
  };
  executive.run_live({clock.now(), over}, clock);
  EXPECT_TRUE(demoted);
  EXPECT_GE(line.stats.hard_overruns, 3U);
  EXPECT_EQ(line.stats.demotions, 1U);
}

}  // namespace
}  // namespace cairn
