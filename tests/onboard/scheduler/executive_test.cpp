// SPDX-License-Identifier: Apache-2.0
// A small pipeline whose result depends on everything that may differ between two runs: how many packets a tick took,
// which values it saw, what was dropped, how many steps it was granted.
#include "onboard/scheduler/executive.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "onboard/scheduler/feed.hpp"
#include "tests/onboard/scheduler/list_source.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;
using test::ListSource;
using Value = std::uint64_t;

Value mix(Value a, Value b) { return (a ^ (b + 0x9E3779B97F4A7C15ULL)) * 0xBF58476D1CE4E5B9ULL; }

class Reader final : public Task {
 public:
  Reader(Source& source, Channel<Value>& out) : feed_(source, SourceId{0}, 0, [](Time, const Error&) {}), out_(out) {}
  void tick(Tick& tick) override {
    while (const Packet* packet = feed_.take(tick)) {
      state_ = mix(state_, packet->sequence);
      if (Value* out = out_.back(tick)) {
        *out = state_;
        out_.push(tick);
      }
    }
    if (feed_.ended()) tick.end_of_input();
  }
  void finish(Tick& tick) override {
    if (Value* out = out_.back(tick)) {
      *out = 4711;
      out_.push(tick);
    }
  }
  Feed feed_;

 private:
  Channel<Value>& out_;
  Value state_ = 0;
};

class Worker final : public Task {
 public:
  Worker(Channel<Value>& in, Channel<Value>& out) : in_(in), out_(out) {}
  void tick(Tick& tick) override {
    while (const Value* in = in_.take(tick)) {
      Budget budget = tick.budget(2, tick.release() + 2ms, 20'000);
      while (budget.one_more()) state_ = mix(state_, *in);
      tick.settle(2, budget);
      if (Value* out = out_.back(tick)) {
        *out = state_;
        out_.push(tick);
      }
      if (tick.regime() != Regime::kDrain) break;
    }
    in_.give_back(tick);
  }

 private:
  Channel<Value>& in_;
  Channel<Value>& out_;
  Value state_ = 0;
};

/// The last of the chain, though first among tasks released together: it sees values a while later.
class Sink final : public Task {
 public:
  explicit Sink(Channel<Value>& in) : in_(in) {}
  void tick(Tick& tick) override {
    while (const Value* in = in_.take(tick)) state = mix(state, mix(*in, tick.index()));
  }
  Value state = 0;

 private:
  Channel<Value>& in_;
};

TaskSpec spec(const char* name, double rate_hz) {
  TaskSpec s;
  s.name = name;
  s.rate_hz = rate_hz;
  return s;
}

struct Pipeline {
  explicit Pipeline(Source& source, std::size_t reserve = 0)
      : sink_line(executive.add(spec("sink", 500))),
        reader_line(executive.add(spec("reader", 200))),
        worker_line(executive.add(spec("worker", 100))),
        first({4, reserve, 1, 0, {}}, reader_line.progress, worker_line.progress),
        second({16, reserve, 1, 0, 5ms}, worker_line.progress, sink_line.progress),
        reader(source, first),
        worker(first, second),
        sink(second) {
    sink_line.task = &sink;
    reader_line.task = &reader;
    worker_line.task = &worker;
    reader_line.input = true;
    worker_line.from = {&first};
    sink_line.from = {&second};
  }
  [[nodiscard]] Value result() const { return sink.state; }

  Executive executive;
  Line &sink_line, &reader_line, &worker_line;
  Channel<Value> first, second;
  Reader reader;
  Worker worker;
  Sink sink;
};

/// Bursts, pauses, and more than the first channel holds.
std::vector<Time> arrivals(Time start) {
  std::vector<Time> list;
  for (int i = 0; i < 60; ++i) list.push_back(start + (i / 7) * 20ms + (i % 7) * 300us);
  return list;
}

Value replay(const std::vector<Time>& list, const ScheduleLog* log, bool threads) {
  ListSource source(list);
  Pipeline p(source, 64);
  const LiveClock clock;
  Executive::ReplayOptions options;
  options.start = p.reader.feed_.first_arrival();
  options.log = log;
  options.pace = threads ? &clock : nullptr;
  EXPECT_TRUE(p.executive.run_replay(options));
  EXPECT_FALSE(p.executive.diverged());
  EXPECT_GT(p.first.dropped(), 0U) << "the test is to cover that, too";
  return p.result();
}

TEST(Executive, VirtualTimeGivesTheSameOnOneThreadAndOnManyAtRealSpeed) {
  const auto list = arrivals(Time{1s});
  const Value once = replay(list, nullptr, false);
  EXPECT_EQ(replay(list, nullptr, false), once);
  EXPECT_EQ(replay(list, nullptr, true), once);
}

/// What the lines left for the log, as a file would hold it.
ScheduleLog log_of(Executive& executive) {
  ScheduleLog log;
  for (Line& line : executive.lines()) {
    TaskLog task{line.spec.name, line.releases, {}, line.next};
    for (; line.log.front() != nullptr; line.log.pop()) task.ticks.push_back(*line.log.front());
    EXPECT_EQ(line.unlogged, 0U);
    log.tasks.push_back(std::move(task));
  }
  return log;
}

TEST(Executive, ALogRepeatsALiveRunToTheBit) {
  const LiveClock clock;
  const Time start = clock.now() + 5ms;
  const auto list = arrivals(start);
  ListSource device(list, &clock);
  Pipeline live(device);
  live.executive.run_live({start, [] { return false; }}, clock);
  EXPECT_EQ(live.reader_line.stats.ticks + live.reader_line.stats.slips, live.reader_line.next)
      << "every release was served or counted";
  const ScheduleLog log = log_of(live.executive);

  EXPECT_EQ(replay(list, &log, false), live.result());
  EXPECT_EQ(replay(list, &log, true), live.result());
}

TEST(Executive, AForeignRecordingIsNoticedAndARunStillEnds) {
  const LiveClock clock;
  const Time start = clock.now();
  const auto list = arrivals(start);
  ListSource device(list, &clock);
  Pipeline live(device);
  live.executive.run_live({start, [] { return false; }}, clock);
  const ScheduleLog log = log_of(live.executive);

  ListSource other({list.begin(), list.begin() + 3});
  Pipeline p(other);
  Executive::ReplayOptions options;
  options.log = &log;
  EXPECT_TRUE(p.executive.run_replay(options));
  EXPECT_TRUE(p.executive.diverged());
  EXPECT_GT(p.reader.feed_.missing(), 0U);

  ListSource again(list);
  Pipeline q(again);
  q.worker_line.spec.rate_hz = 50;
  EXPECT_FALSE(q.executive.run_replay(options)) << "another schedule than the log's";
}

TEST(Executive, MeasuresWhatItRan) {
  const auto list = arrivals(Time{1s});
  ListSource source(list);
  Pipeline p(source);
  const LiveClock clock;
  Executive::ReplayOptions options;
  options.start = Time{1s};
  options.pace = &clock;
  ASSERT_TRUE(p.executive.run_replay(options));
  const TaskStats& s = p.sink_line.stats;
  EXPECT_GT(s.ticks, 90U);
  EXPECT_EQ(s.ticks, s.response.count());
  EXPECT_GE(s.response.max(), s.execution.max());
}

}  // namespace
}  // namespace cairn::scheduler
