// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/silence.hpp"

#include <algorithm>

namespace cairn::scheduler {

bool Silence::pass(Time now) {
  if (!next_arrival_ || now < next_look_) return false;
  next_look_ = now + kLook;
  const Time upcoming = next_arrival_();
  if (upcoming != upcoming_) {
    upcoming_ = upcoming;
    since_ = now;
  }
  if (upcoming == Time::max() || now - since_ < kSettled || upcoming - now <= 2 * kSettled) return false;
  const Time target = upcoming - kSettled;
  for (ScheduledTask& task : graph_.tasks()) {
    if (task.live_only()) continue;
    const std::uint64_t next = std::max(task.next.load(), task.releases.not_before(target));
    task.next = next;
    task.progress.reach(task.releases.at(next) - Duration{1});
  }
  jumped_ += target - now;
  return true;
}

}  // namespace cairn::scheduler
