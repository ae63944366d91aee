// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/drive/canopen/cia402.hpp"

namespace cairn::simulator {

/// The power state machine of a drive (CiA 402-2, figure 10). Pure.
class PowerStates {
 public:
  using State = drive::cia402::State;

  /// Power comes on: a fault that was for ever is gone.
  void power_up() {
    fault_for_ever_ = false;
    boot();
  }
  /// The node starts anew: without voltage at the motor.
  void boot() {
    state_ = State::kSwitchOnDisabled;
    controlword_ = 0;
  }
  /// Takes a controlword. True: it has reset a fault.
  bool obey(std::uint16_t controlword);
  /// A fault of its own. A motor that runs is braked first. `for_ever`: no reset helps.
  void fail(bool moving, bool for_ever);
  /// Leaves operation by the quick stop ramp; no effect in other states.
  void quick_stop() {
    if (state_ == State::kOperationEnabled) state_ = State::kQuickStopActive;
  }
  /// The wheel stands: what ends at standstill has ended.
  void at_rest();

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] std::uint16_t statusword() const;
  [[nodiscard]] bool enabled() const { return state_ == State::kOperationEnabled; }
  /// Enabled, and told to stand for now.
  [[nodiscard]] bool halted() const { return (controlword_ & drive::cia402::kHalt) != 0; }
  /// On the quick stop ramp, by command or by a fault.
  [[nodiscard]] bool braking() const {
    return state_ == State::kQuickStopActive || state_ == State::kFaultReactionActive;
  }

 private:
  void take(unsigned command);

  State state_ = State::kSwitchOnDisabled;
  std::uint16_t controlword_ = 0;
  bool fault_for_ever_ = false;
};

}  // namespace cairn::simulator
