// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/link_monitor.hpp"

namespace cairn::drive {

void LinkMonitor::receive(const CanFrame& frame, Time arrival) {
  if (!frame.error()) {
    down_ = false;
    // An error-passive controller still receives: only its own error frames tell when that is over.
    if (state_ == State::kBusOff) state_ = State::kUp;
    return;
  }
  ++counters_.error_frames;
  if ((frame.id & kErrorNoAck) != 0) ++counters_.no_acks;
  if ((frame.id & kErrorBusOff) != 0) return bus_off(arrival);
  if ((frame.id & kErrorRestarted) != 0 && state_ != State::kFailed) state_ = State::kUp;
  if ((frame.id & kErrorController) != 0) controller(frame.data[1]);
}

void LinkMonitor::controller(std::uint8_t detail) {
  if ((detail & kControllerPassive) != 0) {
    ++counters_.passives;
    if (state_ == State::kUp) state_ = State::kErrorPassive;
    return;
  }
  if ((detail & kControllerWarning) != 0) ++counters_.warnings;
  const bool better = (detail & (kControllerWarning | kControllerActive)) != 0;
  if (better && state_ != State::kFailed) state_ = State::kUp;
}

void LinkMonitor::bus_off(Time now) {
  ++counters_.bus_offs;
  if (state_ == State::kBusOff || state_ == State::kFailed) return;
  retry(now);
}

void LinkMonitor::retry(Time now) {
  state_ = State::kBusOff;
  restarts_ = 0;
  next_restart_ = now + kRestartAfter[0];
}

void LinkMonitor::sent(SendResult result) {
  if (result == SendResult::kQueueFull) {
    ++counters_.queue_fulls;
    ++full_in_a_row_;
    return;
  }
  full_in_a_row_ = 0;
  down_ = result == SendResult::kDown;
}

bool LinkMonitor::step(Time now) {
  if (state_ != State::kBusOff || now < next_restart_) return false;
  if (restarts_ == kRestarts) return state_ = State::kFailed, false;
  // After the last restart the longest pause decides whether it helped.
  next_restart_ = now + kRestartAfter[restarts_ + 1 < kRestarts ? restarts_ + 1 : kRestarts - 1];
  ++restarts_;
  return true;
}

}  // namespace cairn::drive
