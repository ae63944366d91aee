// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/run_end.hpp"

#include <gmock/gmock.h>

#include <string>

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

/// Writes down when it is called, in the regime of the draining alone.
class NotedTask final : public Task {
 public:
  NotedTask(std::string name, std::vector<std::string>& notes) : name_(std::move(name)), notes_(notes) {}
  void tick(Tick& tick) override {
    EXPECT_EQ(tick.regime(), Regime::kDrain);
    notes_.push_back(name_);
    released = tick.release();
  }
  void finish(Tick& /*tick*/) override { notes_.push_back(name_ + " ends"); }
  Time released{};

 private:
  std::string name_;
  std::vector<std::string>& notes_;
};

struct RunEndTest : ::testing::Test {
  static void end(ScheduledTask& task, Time release) {
    TickRecord record;
    Tick tick(Regime::kVirtual, release, record);
    tick.end_of_input();
    task.end_at(tick);
  }
  std::vector<std::string> notes;
  NotedTask a{"a", notes}, b{"b", notes}, c{"c", notes};
  TaskGraph graph;
};

TEST_F(RunEndTest, TheRunStopsAWhileAfterTheLastInputHasEnded) {
  ScheduledTask& first = graph.add({.name = "first"}, a, TaskRole::kInput);
  ScheduledTask& last = graph.add({.name = "last"}, b, TaskRole::kInput);
  graph.add({.name = "stage"}, c);
  EXPECT_EQ(stop_time(graph), Time::max());
  end(first, Time{1s});
  EXPECT_EQ(stop_time(graph), Time::max()) << "the other one goes on";
  end(last, Time{3s});
  end(last, Time{4s});
  EXPECT_EQ(stop_time(graph), Time{3s} + kTail) << "the first time counts";
}

TEST_F(RunEndTest, WithoutInputsItNeverStopsByItself) {
  graph.add({.name = "stage"}, c);
  EXPECT_EQ(stop_time(graph), Time::max());
}

TEST_F(RunEndTest, DrainingGoesDownTheChainAndLeavesOutWhatIsLiveOnly) {
  graph.add({.name = "a"}, a).next = 3;
  graph.add({.name = "b"}, b, TaskRole::kLiveOnly).next = 9;
  graph.add({.name = "c"}, c).next = 5;
  for (ScheduledTask& task : graph.tasks()) task.releases = {Time{1s}, 10ms};
  drain(graph, nullptr);
  EXPECT_THAT(notes, ElementsAre("a", "c", "a ends", "c", "c ends"));
  EXPECT_EQ(a.released, Time{1050ms}) << "after the last tick of them all";
}

}  // namespace
}  // namespace cairn::scheduler
