// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/time.hpp"

namespace cairn {

/// The only class that can tell the time. It is passed to the code that needs it.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual Time now() const = 0;  ///< never decreases

 protected:
  Clock() = default;
  Clock(const Clock&) = default;
  Clock& operator=(const Clock&) = default;
};

/// CLOCK_MONOTONIC of this machine. NTP, PTP or an operator never step it.
class LiveClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override;
  /// CLOCK_REALTIME − CLOCK_MONOTONIC. Added to a Time it gives UTC. For metadata only, never for control.
  [[nodiscard]] static Duration realtime_offset();
  /// Waits until `t`. The time is absolute, so a late caller does not drift. A signal does not end the wait.
  static void wait_until(Time t);
};

/// The time of a recording or of a test. It advances only by advance_to().
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] Time now() const override { return now_; }
  /// Goes on to `t`. A time before now() is ignored.
  void advance_to(Time t) {
    if (t > now_) now_ = t;
  }

 private:
  Time now_{Time::min()};
};

/// CPU time that this thread has used (CLOCK_THREAD_CPUTIME_ID). For reports only, never for logic.
[[nodiscard]] Duration thread_cpu_time();

}  // namespace cairn
