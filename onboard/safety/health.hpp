// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/relaxed_counter.hpp"
#include "hal/time.hpp"

namespace cairn::safety {

/// A task under supervision. Its thread counts `beats` up, as TaskStats::ticks does: no lock, no call.
struct Pulse {
  std::string task;
  Duration limit{};  ///< without a beat, until the task counts as hung; a few periods, and more than its hard budget
  const RelaxedCounter* beats = nullptr;  ///< must outlive the supervisor
};

/// Sees which tasks go on. Pure but for the counters; stepped by a thread that is none of them. Allocates only when it
/// is made. A step that comes late itself accuses nobody: a machine that stood still (SIGSTOP, suspend) gives every
/// task its limit anew.
class Supervisor {
 public:
  explicit Supervisor(std::vector<Pulse> pulses);

  /// A task that has been silent for too long.
  struct Finding {
    std::size_t pulse = 0;  ///< index of the task
    Duration silent{};      ///< since its last beat was seen
  };
  /// The task that has been silent beyond its limit for the longest; none: all are well.
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
