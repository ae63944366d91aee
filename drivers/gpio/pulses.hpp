// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/gpio/config.hpp"
#include "hal/time.hpp"

namespace cairn::gpio {

/// When the output of the camera trigger goes up and down. Missed pulses are left out, and the phase stays. The pulse
/// is made by software, so the scheduler can delay it: what counts is the time when the line was set.
class Trigger {
 public:
  explicit Trigger(const Config& config);
  /// The level to set at `now`, or null when it stays.
  std::optional<bool> step(Time now);
  [[nodiscard]] std::uint64_t pulses() const { return pulses_; }

 private:
  Duration period_, length_;
  std::optional<Time> next_;
  Time fall_{};
  bool high_ = false;
  std::uint64_t pulses_ = 0;
};

/// Checks a pulse per second. A pulse is good if it comes at 1 Hz within 500 ppm.
class PpsMonitor {
 public:
  enum class State : std::uint8_t { kAbsent, kUnlocked, kLocked };
  static constexpr Duration kTolerance = std::chrono::microseconds(500), kAbsence = std::chrono::milliseconds(2500);
  static constexpr int kLockAfter = 3;  ///< good intervals in a row

  /// A rising edge. True if it is one second, or a few whole seconds, after the edge before.
  bool pulse(Time stamp);
  /// Absent after kAbsence without a pulse, locked after kLockAfter good intervals in a row.
  [[nodiscard]] State state(Time now) const;
  [[nodiscard]] std::optional<Time> last() const { return last_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  std::optional<Time> last_;
  int good_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace cairn::gpio
