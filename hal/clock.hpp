// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/time.hpp"

namespace cairn {

/// The only thing that can tell the time; passed to whoever needs it.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual Time now() const = 0;

 protected:
  Clock() = default;
  Clock(const Clock&) = default;
  Clock& operator=(const Clock&) = default;
};

/// CLOCK_MONOTONIC of this machine: never stepped by NTP, PTP or an operator.
class LiveClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override;
  /// CLOCK_REALTIME − CLOCK_MONOTONIC: turns a Time into UTC. Metadata only, never control.
  [[nodiscard]] static Duration realtime_offset();
  /// Waits until `t` (absolute, so that a late caller does not drift); a signal does not end it.
  static void wait_until(Time t);
};

/// Time as the recording tells it. It advances when told to, and never backwards.
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return now_; }
  void advance_to(Time t) {
    if (t > now_) now_ = t;
  }

 private:
  Time now_{Time::min()};
};

/// CPU time this thread has used (CLOCK_THREAD_CPUTIME_ID): for figures in reports, never for logic.
[[nodiscard]] Duration thread_cpu_time();

}  // namespace cairn
