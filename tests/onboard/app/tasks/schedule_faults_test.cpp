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
  Executive executive;
  Line& safety = executive.add(spec("safety", 0));
  Line& line = executive.add(spec("glutton", kHardMs));
  Glutton nothing(0ms), glutton(21ms);
  safety.task = &nothing;
  line.task = &glutton;
  ScheduleFaults faults(executive, safety);
  const LiveClock clock;
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
