// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/drive.hpp"
#include "hal/time.hpp"
#include "onboard/safety/failsafe_config.hpp"
#include "onboard/safety/failsafe_state.hpp"

namespace cairn::safety {

/// The sensors that the failsafe watches for silence.
enum class Watched : std::uint8_t { kLidar, kCamera, kThermal, kDepth, kFeedback };
inline constexpr std::size_t kWatched = 5;

/// When a sensor last gave good data: a scan of at least half a turn, a picture, or a set of wheel readings.
struct Seen {
  Time last{};
  std::uint64_t count = 0;  ///< of good pieces so far
};

/// The state of the e-stop, from EStop of drivers/gpio.
struct EStopView {
  bool released = false;  ///< EStop::released(): the contact is closed now
  bool lost = false;      ///< its level cannot be read, or is too old
  bool latched = true;    ///< EStop::stopped()
};

/// What the robot carries. What it does not carry cannot fail.
struct Fitted {
  std::array<bool, kWatched> watched{};
  bool drive = false, estop = false;
};

/// All that the failsafe looks at in one step.
struct FailsafeInputs {
  Time now{};
  std::array<Seen, kWatched> seen{};
  FaultSet faults;                     ///< active now and found elsewhere: all that do not follow from the other inputs
  DriveStatus drive;                   ///< where one is fitted
  EStopView estop;                     ///< likewise
  std::optional<std::uint32_t> rearm;  ///< the operator's request, with FailsafeDecision::epoch as the operator saw it
};

/// What the robot may do from now on, and why.
struct FailsafeDecision {
  Mode mode = Mode::kStop;
  std::optional<Fault>
      cause;                 ///< of the mode; of a stop: the one that began it; none: normal, never armed, or asked for
  FaultSet active;           ///< all faults that are active now
  FaultSet raised, ended;    ///< since the step before: one event each
  FaultSet blocking;         ///< active faults that stop: no re-arm request is granted while there is one
  double max_speed_m_s = 0;  ///< infinite in normal mode
  std::uint32_t epoch = 0;   ///< to be given with the next re-arm request
  /// True for one step: the request is granted, arm e-stop and drive now. Motion is allowed from the first step in
  /// which neither is latched. When one of them refuses, the robot stays stopped.
  bool arm = false;
};

/// Decides what the robot may do: one pure state machine for the whole robot, stepped by the safety task. It has no
/// clock and no device, allocates nothing, and a step takes bounded time. It is never the only path: drive::Guard,
/// gpio::EStop and the watchdogs of the motor controllers stop the robot by themselves.
class Failsafe {
 public:
  /// A robot with a drive starts stopped, as if never armed.
  Failsafe(const FailsafeConfig& config, const Fitted& fitted);

  const FailsafeDecision& step(const FailsafeInputs& in);
  [[nodiscard]] const FailsafeDecision& decision() const { return decision_; }
  [[nodiscard]] const FaultPolicy& policy() const { return policy_; }

 private:
  struct Limits {
    Duration late = Duration::max(), lost = Duration::max();
    std::optional<Fault> when_late, when_lost;
    std::uint64_t recover = 1;
  };
  struct Watch {
    FaultSet active;
    std::uint64_t count = 0;          ///< of the newest piece
    std::uint64_t missing_count = 0;  ///< when the source was last found missing
    Time at{};                        ///< of the newest piece, or of the first step
  };
  [[nodiscard]] FaultSet missing(const FailsafeInputs& in);
  FaultSet watch(const Limits& limits, const Seen& seen, Watch& watch) const;
  [[nodiscard]] FaultSet of_guards(const FailsafeInputs& in) const;
  [[nodiscard]] FaultSet latched_guards(const FailsafeInputs& in) const;
  void decide(FaultSet active, FaultSet latched);

  Fitted fitted_;
  FaultPolicy policy_;
  std::array<Limits, kWatched> limits_;
  std::array<Watch, kWatched> watch_{};
  double degraded_speed_m_s_;
  Latch latch_;
  bool started_ = false;
  Time now_{};
  FailsafeDecision decision_;
};

/// The fault of a drive's own status. None for kNone, and for stops that are no fault (never armed, requested).
[[nodiscard]] std::optional<Fault> fault_of(DriveCause cause);

/// The command as the mode allows it: slower on the same curve, or zero.
[[nodiscard]] DriveCommand limited(const DriveCommand& command, const FailsafeDecision& decision);

}  // namespace cairn::safety
