// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motor/power_states.hpp"

namespace cairn::simulator {

namespace cia402 = drive::cia402;

bool PowerStates::obey(std::uint16_t controlword) {
  const bool reset = (controlword & cia402::kFaultReset) != 0 && (controlword_ & cia402::kFaultReset) == 0;
  controlword_ = controlword;
  if (state_ == State::kFault) {
    if (!reset || fault_for_ever_) return false;
    state_ = State::kSwitchOnDisabled;
    return true;
  }
  if (state_ != State::kFaultReactionActive) take(controlword & 0x0FU);
  return false;
}

void PowerStates::take(unsigned command) {
  if ((command & 0x02U) == 0) {
    state_ = State::kSwitchOnDisabled;
  } else if ((command & 0x04U) == 0) {
    state_ = state_ == State::kOperationEnabled || state_ == State::kQuickStopActive ? State::kQuickStopActive
                                                                                     : State::kSwitchOnDisabled;
  } else if (state_ == State::kQuickStopActive) {
    return;
  } else if ((command & 0x07U) == 0x06) {
    state_ = State::kReadyToSwitchOn;
  } else if (command == 0x07 && state_ != State::kSwitchOnDisabled) {
    state_ = State::kSwitchedOn;
  } else if (command == 0x0F && (state_ == State::kSwitchedOn || state_ == State::kOperationEnabled)) {
    state_ = State::kOperationEnabled;
  }
}

void PowerStates::fail(bool moving, bool for_ever) {
  state_ = moving && state_ == State::kOperationEnabled ? State::kFaultReactionActive : State::kFault;
  fault_for_ever_ = for_ever;
}

void PowerStates::at_rest() {
  if (state_ == State::kQuickStopActive) state_ = State::kSwitchOnDisabled;
  if (state_ == State::kFaultReactionActive) state_ = State::kFault;
}

std::uint16_t PowerStates::statusword() const {
  switch (state_) {
    case State::kSwitchOnDisabled:
      return 0x0240;
    case State::kReadyToSwitchOn:
      return 0x0231;
    case State::kSwitchedOn:
      return 0x0233;
    case State::kOperationEnabled:
      return 0x0237;
    case State::kQuickStopActive:
      return 0x0217;
    case State::kFaultReactionActive:
      return 0x021F;
    case State::kFault:
      return 0x0218;
    default:
      return 0;
  }
}

}  // namespace cairn::simulator
