// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hal/time.hpp"

namespace cairn::velodyne {

/// UTC of a device time, in µs since 1970. The counter gives the time within the hour, and `reference_utc_us` gives the
/// hour. The reference must be right to ±30 min.
[[nodiscard]] std::int64_t resolve_utc_us(std::uint32_t counter_us, std::int64_t reference_utc_us);

/// Puts the counter of a device (µs past the hour) on the robot's time line.
///
/// The time of a packet is counter + offset. The offset follows the smallest (arrival − packet span − counter) of the
/// last one to two seconds, because transport can only delay a packet. The offset is slewed and never stepped, so
/// jitter of arrival does not bend time inside a scan. If counter and arrival disagree (PPS found or lost, device
/// restarted), the offset is taken anew and the stamp says kJump. Even then stamps never go back.
class DeviceTime {
 public:
  enum class Kind : std::uint8_t {
    kFirst,      ///< nothing to compare with yet
    kNext,       ///< follows the previous packet
    kDuplicate,  ///< same device time as the previous packet: do not use
    kLate,       ///< older than the previous packet or overlapping it: do not use
    kJump        ///< device time or arrival jumped: earlier measurements do not connect to this packet
  };
  /// The time of one packet.
  struct Stamp {
    Kind kind = Kind::kFirst;
    Time first_firing{};  ///< robot's time line; at least kBusyShare of its span after the previous packet's
    Duration step{};      ///< device time since the previous packet; for kNext
  };

  /// The stamp of the next packet. `span`: from its first firing to its sending. |arrival| < 2^61 ns. `exact`: the time
  /// of the first firing if PPS gives it. It is used while it agrees with arrival to kExactTolerance.
  Stamp update(std::uint32_t counter_us, Time arrival, Duration span, std::optional<Time> exact = std::nullopt);

  static constexpr Duration kReorderWindow = std::chrono::milliseconds(50);  ///< older packets mean a jump
  static constexpr int kMaxLateRun = 8;                                      ///< more late packets in a row: a jump
  static constexpr Duration kMaxEarly = std::chrono::milliseconds(20);       ///< earlier than this: a jump
  static constexpr Duration kMaxDelay = std::chrono::seconds(1);             ///< later than any queue explains: a jump
  static constexpr Duration kMaxWindowError =
      std::chrono::milliseconds(10);                            ///< a whole window later than this: a jump
  static constexpr Duration kWindow = std::chrono::seconds(1);  ///< over which the smallest delay is taken
  static constexpr Duration kExactTolerance = std::chrono::milliseconds(100);
  static constexpr int kFastSlew = 100;   ///< one part in … during the first window after a start or jump
  static constexpr int kSlowSlew = 2000;  ///< one part in … later: 500 ppm follows any crystal

  /// All firings of a packet begin within this share of its span (the rest is the last sequence's recharge).
  [[nodiscard]] static constexpr Duration busy_share(Duration span) { return span * 63 / 64; }

 private:
  [[nodiscard]] Duration step_from_last(std::uint32_t counter_us, Time arrival) const;
  Time unbroken(Time arrival);
  Stamp restart(Kind kind, Time first_firing, Time arrival);
  bool rotate_window(Time arrival, Duration sample);
  void slew(Duration step, Time arrival);
  [[nodiscard]] Time last_first_firing() const { return Time{device_ + offset_}; }

  bool started_ = false;
  bool arrival_broken_ = false;  // the last arrival went back
  std::uint32_t counter_us_ = 0;
  Time arrival_{};            // of the last packet, arrival_shift_ included
  Duration arrival_shift_{};  // keeps a broken recording's arrivals from going back
  Duration device_{};         // sum of the counter's steps
  Duration offset_{};         // first firing = device_ + offset_
  Duration span_{};           // of the last packet
  Time offset_since_{};       // arrival at which the offset was taken
  Time window_start_{};
  Duration window_min_{}, previous_min_{};  // smallest samples of the running window and the one before
  int late_run_ = 0;
};

}  // namespace cairn::velodyne
