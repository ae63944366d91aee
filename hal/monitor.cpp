// SPDX-License-Identifier: Apache-2.0
#include "hal/monitor.hpp"

#include <algorithm>

namespace cairn {

void StageStats::record(Duration elapsed) {
  wall.record(elapsed);
  if (budget > Duration{} && elapsed > budget) ++overruns;
}

StageStats& Monitor::stage(std::string_view name, Duration budget) {
  const std::lock_guard lock(mutex_);
  for (StageStats& s : stages_)
    if (s.name == name) return s;
  StageStats& s = stages_.emplace_back();
  s.name = name;
  s.budget = budget;
  return s;
}

void Monitor::event(Time when, std::string_view stage, std::string_view what) {
  const std::lock_guard lock(mutex_);
  const auto same = [&](const Event& e) { return e.stage == stage && e.what == what; };
  if (const auto known = std::find_if(events_.begin(), events_.end(), same); known != events_.end()) {
    known->last = when;
    ++known->count;
  } else if (events_.size() < kMaxEvents) {
    events_.push_back({when, when, std::string(stage), std::string(what), 1});
  } else {
    ++dropped_events_;
    return;
  }
  kept_events_.fetch_add(1, std::memory_order_release);
}

std::vector<Event> Monitor::events_now() const {
  const std::lock_guard lock(mutex_);
  return events_;
}

StageTimer::~StageTimer() {
  const Duration wall = LiveClock{}.now() - wall_;
  stage_.cpu.record(thread_cpu_time() - cpu_);
  stage_.record(wall);
}

}  // namespace cairn
