// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/run_end.hpp"

#include <algorithm>

namespace cairn::scheduler {

Time stop_time(const TaskGraph& graph) {
  Time last = Time::min();
  for (const ScheduledTask& task : graph.tasks())
    if (task.is_input()) last = std::max(last, task.ended_at());
  return last == Time::max() || last == Time::min() ? Time::max() : last + kTail;
}

void drain(TaskGraph& graph, const Clock* clock) {
  std::vector<ScheduledTask*> tasks;
  Time end = Time::min();
  for (ScheduledTask& task : graph.tasks()) {
    if (task.live_only()) continue;
    tasks.push_back(&task);
    end = std::max(end, task.releases.at(task.next));
  }
  TickRecord unused;
  const auto last_tick = [&] { return Tick(Regime::kDrain, end, unused, nullptr, clock); };
  const auto use_what_is_left = [&](std::size_t i) {
    Tick tick = last_tick();
    tasks[i]->task.tick(tick);
  };
  for (std::size_t i = 0; i < tasks.size(); ++i) use_what_is_left(i);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    Tick tick = last_tick();
    tasks[i]->task.finish(tick);
    for (std::size_t after = i + 1; after < tasks.size(); ++after) use_what_is_left(after);
  }
}

}  // namespace cairn::scheduler
