// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>

#include "onboard/safety/fault.hpp"

namespace cairn::safety {

/// Which faults lead to which mode, as masks: the table of a profile.
struct FaultPolicy {
  FaultSet degrade, hold, stop;

  [[nodiscard]] constexpr Mode demanded_by(FaultSet active) const {
    if (!(active & stop).empty()) return Mode::kStop;
    if (!(active & hold).empty()) return Mode::kHold;
    return (active & degrade).empty() ? Mode::kNormal : Mode::kDegraded;
  }
  /// The first of the worst active faults; none in normal mode.
  [[nodiscard]] constexpr std::optional<Fault> worst_of(FaultSet active) const {
    for (const FaultSet group : {active & stop, active & hold, active & degrade})
      if (!group.empty()) return static_cast<Fault>(std::countr_zero(group.bits()));
    return std::nullopt;
  }
};

/// Whether the robot may move at all: the latch. A state machine of three states, pure and without time.
///
///     kRunning ── a fault that stops, or a guard that stopped ──▶ kStopped ── re-arm request, nothing stops ──▶
///     kArming
///        ▲                                                           ▲── a fault that stops, a guard still latched ──┤
///        └───────────────────────────────── all guards are armed again ─────────────────────────────────────────────┘
struct Latch {
  enum class State : std::uint8_t { kRunning, kStopped, kArming };

  /// The facts for one step of the latch.
  struct Inputs {
    bool stop = false;                   ///< a fault that stops is active now
    bool guard_latched = false;          ///< drive or e-stop are in a stop of their own, which their own arming ends
    std::optional<std::uint32_t> rearm;  ///< the operator's request, with the epoch of the stop that it ends
  };

  State state = State::kStopped;
  std::uint32_t epoch = 0;  ///< counts re-armings: a request that was delayed or repeated ends no later stop

  [[nodiscard]] constexpr Latch next(const Inputs& in) const {
    if (in.stop) return {State::kStopped, epoch};
    switch (state) {
      case State::kRunning:
        return {in.guard_latched ? State::kStopped : State::kRunning, epoch};
      case State::kStopped:
        return in.rearm && *in.rearm == epoch ? Latch{State::kArming, epoch + 1} : *this;
      case State::kArming:
        return {in.guard_latched ? State::kStopped : State::kRunning, epoch};
    }
    return {State::kStopped, epoch};
  }
  friend constexpr bool operator==(const Latch&, const Latch&) = default;
};

}  // namespace cairn::safety
