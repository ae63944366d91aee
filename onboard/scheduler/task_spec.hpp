// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "hal/config/config.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::scheduler {

/// One fixed-rate task of the robot profile. Release k is at start + phase + k·period, on CLOCK_MONOTONIC when live.
struct TaskSpec {
  std::string name;        ///< given by the program
  double rate_hz = 100;    ///< releases per second
  double phase_ms = 0;     ///< of the first release
  double deadline_ms = 0;  ///< from the release to the end of the tick; 0: the period
  double soft_ms = 0;      ///< execution time that is planned for; more is counted. 0: none declared
  double hard_ms = 0;      ///< execution time beyond which the tick counts as failed; 0: none declared
  double busy_hz = 0;      ///< releases per second that find work (a scan, say); 0: all of them
  int priority = 0;        ///< SCHED_FIFO 1…99; 0: SCHED_OTHER
  int core = -1;           ///< the CPU it is bound to; -1: any

  [[nodiscard]] Duration period() const { return from_seconds(1.0 / rate_hz); }
  [[nodiscard]] Duration phase() const { return from_seconds(1e-3 * phase_ms); }
  [[nodiscard]] Duration deadline() const { return deadline_ms > 0 ? from_seconds(1e-3 * deadline_ms) : period(); }
  [[nodiscard]] Duration soft() const { return from_seconds(1e-3 * soft_ms); }
  [[nodiscard]] Duration hard() const { return from_seconds(1e-3 * hard_ms); }
  /// The share of one core that its declared budget takes: soft · (busy_hz or rate_hz).
  [[nodiscard]] double utilisation() const { return 1e-3 * soft_ms * (busy_hz > 0 ? busy_hz : rate_hz); }
};

void declare(config::Section& section, TaskSpec& spec);

/// How much of a core may be promised away. Rate-monotonic scheduling is safe below 69 % (Liu & Layland 1973).
inline constexpr double kMaxUtilisation = 0.70;

/// The tasks with period, budgets and utilisation, and the sum of each core: for reading.
[[nodiscard]] std::string to_table(std::span<const TaskSpec> tasks, int cores);

/// Refuses, with to_table(), a core that more than kMaxUtilisation is promised of, tasks bound to a core the machine
/// has not got, a soft budget above the hard one and a hard one above the deadline. All faults at once.
[[nodiscard]] Result<void> validate(std::span<const TaskSpec> tasks, int cores);

}  // namespace cairn::scheduler
