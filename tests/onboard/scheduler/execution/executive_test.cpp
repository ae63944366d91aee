// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/executive.hpp"

#include <gtest/gtest.h>

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
  EXPECT_TRUE(executive.run_replay(options));
  EXPECT_FALSE(executive.diverged());
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

TEST(Executive, AForeignRecordingIsNoticedAndARunStillEnds) {
  const LiveClock clock;
  const Time start = clock.now();
  const auto list = arrivals(start);
  ListSource device(list, &clock);
  Pipeline live(device);
  Executive(live.graph).run_live({start, [] { return false; }}, clock);
  const ScheduleLog log = log_of(live.graph);

  ListSource other({list.begin(), list.begin() + 3});
  Pipeline p(other);
  Executive executive(p.graph);
  EXPECT_TRUE(executive.run_replay({.log = &log}));
  EXPECT_TRUE(executive.diverged());
  EXPECT_GT(p.reader.feed.missing(), 0U);

  ListSource again(list);
  Pipeline q(again);
  q.working.spec.rate_hz = 50;
  EXPECT_FALSE(Executive(q.graph).run_replay({.log = &log})) << "another schedule than the log's";
}

}  // namespace
}  // namespace cairn::scheduler
