// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/gpio/config.hpp"
#include "hal/time.hpp"

namespace cairn::gpio {

/// The camera trigger's output: when it goes up and down. Pulses that were missed are left out; the phase stays. Made
/// by software, so a pulse may be late by what the scheduler takes: read the exposure's time from the camera, or from
/// the trigger looped back to an input.
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

/// Judges a pulse per second: 1 Hz within 500 ppm, else the pulse is refused.
class PpsMonitor {
 public:
  enum class State : std::uint8_t { kAbsent, kUnlocked, kLocked };
  static constexpr Duration kTolerance = std::chrono::microseconds(500), kAbsence = std::chrono::milliseconds(2500);
  static constexpr int kLockAfter = 3;  ///< good intervals in a row

  /// A rising edge. True when it is one second after the one before (or a few).
  bool pulse(Time stamp);
  [[nodiscard]] State state(Time now) const;
  [[nodiscard]] std::optional<Time> last() const { return last_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  std::optional<Time> last_;
  int good_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace cairn::gpio
