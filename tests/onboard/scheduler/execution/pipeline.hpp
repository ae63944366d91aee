// SPDX-License-Identifier: Apache-2.0
// A small pipeline whose result depends on everything that may differ between two runs: how many packets a tick took,
// which values it saw, what was dropped, how many steps it was granted.
#pragma once

#include <cstdint>
#include <vector>

#include "onboard/scheduler/feed.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::scheduler::test {

using Value = std::uint64_t;

inline Value mix(Value a, Value b) { return (a ^ (b + 0x9E3779B97F4A7C15ULL)) * 0xBF58476D1CE4E5B9ULL; }

class Reader final : public Task {
 public:
  explicit Reader(Source& source) : feed(source, SourceId{0}, take_slots(), [](Time, const Error&) {}) {}
  void tick(Tick& tick) override {
    while (const Packet* packet = feed.take(tick)) {
      state_ = mix(state_, packet->sequence);
      push(state_, tick);
    }
    if (feed.ended()) tick.end_of_input();
  }
  void finish(Tick& tick) override { push(4711, tick); }

  Feed feed;
  OutputPort<Value> values{*this, "values"};

 private:
  void push(Value value, Tick& tick) {
    if (Value* out = values.back(tick)) {
      *out = value;
      values.push(tick);
    }
  }
  Value state_ = 0;
};

class Worker final : public Task {
 public:
  void tick(Tick& tick) override {
    while (const Value* in = values.take(tick)) {
      Budget budget = tick.budget(steps, tick.release() + std::chrono::milliseconds(2), 20'000);
      while (budget.one_more()) state_ = mix(state_, *in);
      tick.settle(steps, budget);
      if (Value* out = results.back(tick)) {
        *out = state_;
        results.push(tick);
      }
      if (tick.regime() != Regime::kDrain) break;
    }
    values.give_back(tick);
  }

  InputPort<Value> values{*this, "values"};
  OutputPort<Value> results{*this, "results"};
  const std::size_t steps = take_slots();

 private:
  Value state_ = 0;
};

/// The last of the chain, though first among tasks released together: it sees values a while later.
class Sink final : public Task {
 public:
  void tick(Tick& tick) override {
    while (const Value* in = results.take(tick)) state = mix(state, mix(*in, tick.index()));
  }
  InputPort<Value> results{*this, "results"};
  Value state = 0;
};

struct Pipeline {
  explicit Pipeline(Source& source, std::size_t reserve = 0) : reader(source) {
    graph.connect(reader.values, worker.values, {.capacity = 4, .reserve = reserve});
    graph.connect(worker.results, sink.results,
                  {.capacity = 16, .reserve = reserve, .lag = std::chrono::milliseconds(5)});
  }
  [[nodiscard]] Value result() const { return sink.state; }
  [[nodiscard]] std::uint64_t dropped() const { return worker.values.channel()->fill().dropped; }

  Reader reader;
  Worker worker;
  Sink sink;
  TaskGraph graph;
  ScheduledTask& sinking = graph.add({.name = "sink", .rate_hz = 500}, sink);
  ScheduledTask& reading = graph.add({.name = "reader", .rate_hz = 200}, reader, TaskRole::kInput);
  ScheduledTask& working = graph.add({.name = "worker", .rate_hz = 100}, worker);
};

/// Bursts, pauses, and more than the first channel holds.
inline std::vector<Time> arrivals(Time start) {
  using namespace std::chrono_literals;
  std::vector<Time> list;
  for (int i = 0; i < 60; ++i) list.push_back(start + (i / 7) * 20ms + (i % 7) * 300us);
  return list;
}

/// What the tasks left for the log, as a file would hold it.
inline ScheduleLog log_of(TaskGraph& graph) {
  ScheduleLog log;
  for (ScheduledTask& task : graph.tasks()) {
    TaskLog logged{task.spec.name, task.releases, {}, task.next};
    for (; task.log.front() != nullptr; task.log.pop()) logged.ticks.push_back(*task.log.front());
    log.tasks.push_back(std::move(logged));
  }
  return log;
}

}  // namespace cairn::scheduler::test
