// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::recording {

/// Waits for at most the given time.
using Waiter = std::function<void(Duration)>;
/// Waits in the kernel; a signal ends the wait early.
[[nodiscard]] Waiter live_waiter();

/// Hands out recorded packets as fast as they came (`cairn send`): the first at once, each later one when the time
/// between their arrivals has passed. Packets are not changed.
class PacedSource final : public Source {
 public:
  /// `recorded` and `clock` must outlive it. `rate` 2 replays twice as fast; it must be positive.
  PacedSource(Source& recorded, const Clock& clock, Waiter wait, double rate = 1.0);

  Result<Poll> next(Packet& packet, Duration timeout) override;

 private:
  [[nodiscard]] Time due() const;

  Source& recorded_;
  const Clock& clock_;
  Waiter wait_;
  double rate_;
  Packet pending_;
  bool has_pending_ = false;
  struct Start {
    Time clock, arrival;
  };
  std::optional<Start> start_;
};

}  // namespace cairn::recording
