// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "hal/time.hpp"

namespace cairn::scheduler {

/// How far a task has come. Every tick that was released up to then is done, and its outputs are handed over.
class Progress {
 public:
  void reach(Time release) { done_.store(release.time_since_epoch().count(), std::memory_order_release); }
  [[nodiscard]] bool reached(Time t) const {
    return done_.load(std::memory_order_acquire) >= t.time_since_epoch().count();
  }
  /// No tick will follow.
  void finish() { reach(Time::max()); }

 private:
  std::atomic<Time::rep> done_{Time::min().time_since_epoch().count()};
};

}  // namespace cairn::scheduler
