// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::recording {

/// Waits for a span of time, or less.
using Waiter = std::function<void(Duration)>;
/// Waits in the kernel; a signal ends the wait early.
[[nodiscard]] Waiter live_waiter();

/// Hands out recorded packets as fast as they came (`--speed real`): the first one at once, every other one when as
/// much time has passed as lies between their arrivals. Packets are not changed.
class PacedSource final : public Source {
 public:
  /// `recorded` and `clock` are borrowed. `rate` 2 replays twice as fast; it must be positive.
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
