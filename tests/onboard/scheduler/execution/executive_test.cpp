// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/executive.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <utility>
#include <vector>

#include "tests/onboard/scheduler/execution/pipeline.hpp"
#include "tests/onboard/scheduler/list_source.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;
using test::arrivals;
using test::ListSource;
using test::log_of;
using test::Pipeline;
using test::Value;

Value replay(const std::vector<Time>& list, const ScheduleLog* log, bool threads) {
  ListSource source(list);
  Pipeline p(source, 64);
  Executive executive(p.graph);
  const LiveClock clock;
  const ReplayOptions options{.start = p.reader.feed.first_arrival(), .log = log, .pace = threads ? &clock : nullptr};
  const auto end = executive.run_replay(options);
  EXPECT_TRUE(end && !end->diverged && !end->interrupted);
  EXPECT_GT(p.dropped(), 0U) << "the test is to cover that, too";
  return p.result();
}

TEST(Executive, VirtualTimeGivesTheSameOnOneThreadAndOnManyAtRealSpeed) {
  const auto list = arrivals(Time{1s});
  const Value once = replay(list, nullptr, false);
  EXPECT_EQ(replay(list, nullptr, false), once);
  EXPECT_EQ(replay(list, nullptr, true), once);
}

TEST(Executive, ALogRepeatsALiveRunToTheBit) {
  const LiveClock clock;
  const Time start = clock.now() + 5ms;
  const auto list = arrivals(start);
  ListSource device(list, &clock);
  Pipeline live(device);
  Executive(live.graph).run_live({start, [] { return false; }}, clock);
  EXPECT_EQ(live.reading.stats.ticks + live.reading.stats.slips, live.reading.next)
      << "every release was served or counted";
  for (const ScheduledTask& task : live.graph.tasks()) EXPECT_EQ(task.unlogged, 0U);
  const ScheduleLog log = log_of(live.graph);

  EXPECT_EQ(replay(list, &log, false), live.result());
  EXPECT_EQ(replay(list, &log, true), live.result());
}

/// What a live run of these arrivals left for the log, with its list.
std::pair<std::vector<Time>, ScheduleLog> run_live() {
  const LiveClock clock;
  const Time start = clock.now();
  auto list = arrivals(start);
  ListSource device(list, &clock);
  Pipeline live(device);
  Executive(live.graph).run_live({start, [] { return false; }}, clock);
  return {std::move(list), log_of(live.graph)};
}

TEST(Executive, AForeignRecordingIsNoticedAndARunStillEnds) {
  bool diverged = false;
  // On a machine that stands still until all packets have come, the worker takes too few to miss any. Then all run
  // anew.
  for (int i = 0; i < 100 && !diverged; ++i) {
    const auto [list, log] = run_live();
    ListSource other({list.begin(), list.begin() + 3});
    Pipeline p(other);
    const auto end = Executive(p.graph).run_replay({.log = &log});
    ASSERT_TRUE(end);
    EXPECT_GT(p.reader.feed.missing(), 0U);
    diverged = end->diverged;
  }
  EXPECT_TRUE(diverged);
}

TEST(Executive, AnotherScheduleThanTheLogsIsRefused) {
  const auto [list, log] = run_live();
  ListSource again(list);
  Pipeline p(again);
  p.working.spec.rate_hz = 50;
  EXPECT_FALSE(Executive(p.graph).run_replay({.log = &log}));
}

TEST(Executive, AReplayStopsBeforeTheTickThatItIsAskedFor) {
  for (const bool threads : {false, true}) {
    ListSource source(arrivals(Time{1s}));
    Pipeline p(source, 64);
    std::atomic<int> asked = 0;
    const LiveClock clock;
    const auto end = Executive(p.graph).run_replay(
        {.start = Time{1s}, .pace = threads ? &clock : nullptr, .stop = [&] { return ++asked > 40; }});
    ASSERT_TRUE(end);
    EXPECT_TRUE(end->interrupted);
    std::uint64_t ticks = 0;
    for (const ScheduledTask& task : p.graph.tasks()) ticks += task.stats.ticks;
    EXPECT_LE(ticks, 40U);
    EXPECT_GT(p.sink.state, 0U) << "what was begun is brought to its end";
  }
}

}  // namespace
}  // namespace cairn::scheduler
