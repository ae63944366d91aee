// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/histogram.hpp"
#include "hal/relaxed_counter.hpp"

namespace cairn::scheduler {

/// What the ticks of one task cost (docs/real-time.md). The task's thread writes, any thread reads.
struct TaskStats {
  RelaxedCounter ticks;
  RelaxedCounter slips;          ///< releases passed because an earlier tick was still running
  RelaxedCounter misses;         ///< response above the deadline
  RelaxedCounter soft_overruns;  ///< execution above soft_ms
  RelaxedCounter hard_overruns;  ///< execution above hard_ms: the next release was skipped
  RelaxedCounter demotions;      ///< to every second release, after three hard overruns in a row
  RelaxedCounter demoted;        ///< 1 while the task is demoted
  RelaxedCounter warm_ticks;     ///< ticks after the warm-up: those that the next four are about
  RelaxedCounter allocations;    ///< by operator new, after the warm-up
  RelaxedCounter major_faults, minor_faults, involuntary_switches;  ///< of the thread, after the warm-up
  Histogram wake;                                                   ///< start − release
  Histogram response;                                               ///< end − release, so that a late start is in it
  Histogram execution;                                              ///< end − start
  Histogram cpu;                                                    ///< CPU time of the thread

  /// Ticks took time. False in virtual time: all but `ticks` is then not known.
  [[nodiscard]] bool measured() const { return response.count() > 0; }
  /// The run outlasted the warm-up: allocations, page faults and switches were counted.
  [[nodiscard]] bool usage_measured() const { return warm_ticks > 0; }
};

}  // namespace cairn::scheduler
