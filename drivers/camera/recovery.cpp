// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/recovery.hpp"

#include <algorithm>

namespace cairn::camera {

Recovery::Recovery(Time now, Duration silence) : silence_(silence), at_(now + silence) {}

Recovery::Step Recovery::step(Time now) const {
  const bool due = now >= at_;
  switch (state_) {
    case State::kStreaming:
      if (!due) return Step::kRead;
      break;
    case State::kBroken:
      break;
    case State::kLost:
      return due ? Step::kReopen : Step::kWait;
  }
  return restarts_ < kMaxRestarts ? Step::kRestart : Step::kReopen;
}

void Recovery::frame(Time now) {
  restarts_ = 0;
  delay_ = kFirstDelay;
  stream(now);
}

void Recovery::broken(Time now) {
  state_ = State::kBroken;
  at_ = now;
}

void Recovery::lost(Time now) {
  state_ = State::kLost;
  at_ = now + delay_;
  delay_ = std::min(2 * delay_, kMaxDelay);
}

void Recovery::restarted(Time now) {
  ++restarts_;
  stream(now);
}

void Recovery::reopened(Time now) {
  restarts_ = 0;
  stream(now);
}

void Recovery::stream(Time now) {
  state_ = State::kStreaming;
  at_ = now + silence_;
}

}  // namespace cairn::camera
