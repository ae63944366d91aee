// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/safety/fault.hpp"
#include "onboard/scheduler/executive.hpp"

namespace cairn {

/// What the figures of a live executive say is wrong. Looked at by the watch task.
class ScheduleFaults {
 public:
  /// Both must outlive it; `safety` is one of the executive's lines.
  ScheduleFaults(const scheduler::Executive& executive, const scheduler::Line& safety)
      : executive_(executive), safety_(safety) {}

  /// kSafetyMissed: the safety task missed a deadline since the last look. kStageDemoted: a task runs at half its rate
  /// because it kept overrunning its hard budget.
  FaultSet look() {
    FaultSet faults;
    const std::uint64_t misses = safety_.stats.misses;
    faults.set(Fault::kSafetyMissed, misses != misses_);
    misses_ = misses;
    for (const scheduler::Line& line : executive_.lines())
      if (!line.live_only && line.stats.demoted != 0) faults.set(Fault::kStageDemoted);
    return faults;
  }

 private:
  const scheduler::Executive& executive_;
  const scheduler::Line& safety_;
  std::uint64_t misses_ = 0;
};

}  // namespace cairn
