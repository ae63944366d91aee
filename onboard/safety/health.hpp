// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/relaxed_counter.hpp"
#include "hal/time.hpp"

namespace cairn::safety {

/// A task under supervision. Its thread counts `beats`, such as TaskStats::ticks: no lock, no call.
struct Pulse {
  std::string task;
  Duration limit{};  ///< without a beat for so long, the task hangs; a few periods, and more than its hard budget
  const RelaxedCounter* beats = nullptr;  ///< must outlive the supervisor
};

/// Finds tasks that hang. Pure but for the counters; stepped by another thread than theirs. Allocates only when it is
/// constructed. A step that comes late itself finds nothing: after a machine that stood still (SIGSTOP, suspend), every
/// task has its whole limit again.
class Supervisor {
 public:
  explicit Supervisor(std::vector<Pulse> pulses);

  /// A task that has been silent for too long.
  struct Finding {
    std::size_t pulse = 0;  ///< index of the task
    Duration silent{};      ///< since its last beat was seen
  };
  /// The task that is longest beyond its limit; none: all tasks run.
  std::optional<Finding> step(Time now);

  [[nodiscard]] const std::vector<Pulse>& pulses() const { return pulses_; }

 private:
  struct Last {
    std::uint64_t beats = 0;
    Time at{};
  };
  std::vector<Pulse> pulses_;
  std::vector<Last> last_;
  std::optional<Time> stepped_;
};

}  // namespace cairn::safety
