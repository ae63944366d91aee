// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/pulses.hpp"

#include <algorithm>

namespace cairn::gpio {

Trigger::Trigger(const Config& config)
    : period_(from_seconds(1 / config.trigger_rate_hz)), length_(from_seconds(config.trigger_pulse_ms / 1000)) {}

std::optional<bool> Trigger::step(Time now) {
  if (high_) {
    if (now < fall_) return std::nullopt;
    return high_ = false;
  }
  if (next_ && now < *next_) return std::nullopt;
  next_ = next_ ? *next_ + period_ * ((now - *next_) / period_ + 1) : now + period_;
  fall_ = now + length_;
  ++pulses_;
  return high_ = true;
}

bool PpsMonitor::pulse(Time stamp) {
  constexpr Duration kSecond = std::chrono::seconds(1);
  if (!last_ || stamp - *last_ > kAbsence || stamp <= *last_) {
    good_ = 0;
    last_ = stamp;
    return false;
  }
  const Duration interval = stamp - *last_;
  // One pulse may be missing; the tolerance grows with the interval.
  const auto seconds = std::max<std::int64_t>(1, (interval + kSecond / 2) / kSecond);
  if (std::chrono::abs(interval - kSecond * seconds) > kTolerance * seconds) {
    ++refused_;
    // A disturbance between two good pulses does not move the second; a second that moved must prove itself again.
    if (interval > kSecond) {
      last_ = stamp;
      good_ = 0;
    }
    return false;
  }
  last_ = stamp;
  ++good_;
  return true;
}

PpsMonitor::State PpsMonitor::state(Time now) const {
  if (!last_ || now - *last_ > kAbsence) return State::kAbsent;
  return good_ >= kLockAfter ? State::kLocked : State::kUnlocked;
}

}  // namespace cairn::gpio
