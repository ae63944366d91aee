// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "hal/config/config.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::scheduler {

/// One fixed-rate task of the robot profile. Release k is at start + phase + k·period; live, on CLOCK_MONOTONIC.
struct TaskSpec {
  std::string name;        ///< given by the program
  double rate_hz = 100;    ///< releases per second
  double phase_ms = 0;     ///< of the first release
  double deadline_ms = 0;  ///< from the release to the end of the tick; 0: the period
  double soft_ms = 0;      ///< planned execution time; more is counted as an overrun. 0: none declared
  double hard_ms = 0;      ///< execution time above which a tick has failed; 0: none declared
  double busy_hz = 0;      ///< releases per second that find work, such as a scan; 0: all of them
  int priority = 0;        ///< SCHED_FIFO 1…99; 0: SCHED_OTHER
  int nice = 0;            ///< of SCHED_OTHER: 0…19, the higher the weaker
  int core = -1;           ///< the CPU that it is bound to; -1: any

  [[nodiscard]] Duration period() const { return from_seconds(1.0 / rate_hz); }
  [[nodiscard]] Duration phase() const { return from_seconds(1e-3 * phase_ms); }
  [[nodiscard]] Duration deadline() const { return deadline_ms > 0 ? from_seconds(1e-3 * deadline_ms) : period(); }
  [[nodiscard]] Duration soft() const { return from_seconds(1e-3 * soft_ms); }
  [[nodiscard]] Duration hard() const { return from_seconds(1e-3 * hard_ms); }
  /// The share of one core that the soft budget takes, 0…1: soft_ms · (busy_hz or rate_hz).
  [[nodiscard]] double utilisation() const { return 1e-3 * soft_ms * (busy_hz > 0 ? busy_hz : rate_hz); }
};

void declare(config::Section& section, TaskSpec& spec);

/// The largest share of a core that all tasks on it may plan. Rate-monotonic scheduling is safe below 69 % (Liu &
/// Layland 1973).
inline constexpr double kMaxUtilisation = 0.70;
/// The same with weak tasks, which have `nice` above 0: they use what others leave, and delay nobody.
inline constexpr double kMaxWithWeak = 0.95;

/// The tasks with rates, budgets and shares, and the sum for each core: a table in plain text.
[[nodiscard]] std::string to_table(std::span<const TaskSpec> tasks, int cores);

/// Error kInvalidConfig, with all faults and to_table():
/// - the tasks plan more than kMaxUtilisation of a core, or with weak tasks more than kMaxWithWeak
/// - a task is bound to a core that the machine does not have
/// - a soft budget is above the hard one, or a hard one above the deadline
[[nodiscard]] Result<void> validate(std::span<const TaskSpec> tasks, int cores);

}  // namespace cairn::scheduler
