// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/velodyne/delay_filter.hpp"
#include "hal/time.hpp"

namespace cairn::velodyne {

/// UTC of a device time, in µs since 1970. The counter gives the time within the hour, and `reference_utc_us` gives the
/// hour. The reference must be right to ±30 min.
[[nodiscard]] std::int64_t resolve_utc_us(std::uint32_t counter_us, std::int64_t reference_utc_us);

/// Puts the counter of a device (µs past the hour) on the robot's time line.
///
/// The time of a packet is counter + offset. Transport can only delay a packet, so the offset follows the smallest
/// (arrival − packet span − counter) of the last one to two seconds. A late packet changes nothing. An early packet
/// shows that all earlier ones were late. The stamps then catch up without a step (DelayFilter), so that they never go
/// back and time inside a scan stays even. Before the first scan is given out, the clock just begins again.
///
/// A packet that contradicts the ones before (its counter went back or ran ahead of arrival) is set aside. When
/// kMaxSetAside in a row were, the next one is believed: PPS was found or lost, or the device restarted. The offset is
/// then taken anew and the stamp says kJump. Even then stamps never go back.
class DeviceTime {
 public:
  enum class Kind : std::uint8_t {
    kFirst,      ///< nothing to compare with yet, or all before was held up in a queue: begin anew with this packet
    kNext,       ///< follows the previous packet
    kDuplicate,  ///< same device time as the previous packet: do not use
    kLate,       ///< older than the previous packet or overlapping it: do not use
    kAhead,      ///< its counter ran ahead of arrival: do not use
    kJump        ///< device time or arrival jumped: earlier measurements do not connect to this packet
  };
  /// The time of one packet.
  struct Stamp {
    Kind kind = Kind::kFirst;
    Time first_firing{};  ///< robot's time line; at least busy_share(span) · pace after the previous packet's
    Duration step{};      ///< device time since the previous packet
    double pace = 1;      ///< robot time per device time inside this packet; below 1 while late stamps are caught up
  };

  /// The stamp of the next packet. `span`: from its first firing to its sending. |arrival| < 2^61 ns. `exact`: the time
  /// of the first firing if PPS gives it. It is used while it agrees with arrival to kExactTolerance.
  Stamp update(std::uint32_t counter_us, Time arrival, Duration span, std::optional<Time> exact = std::nullopt);

  /// Stamps are later than the truth by this much, as far as arrivals have shown.
  [[nodiscard]] Duration late_by() const { return started_ ? delay_.offset() - delay_.smallest() : Duration{}; }
  /// A scan was given out: from now on stamps never go back, not even where all before was held up in a queue.
  void hold_stamps() { may_begin_again_ = false; }

  static constexpr int kMaxSetAside = 8;  ///< packets in a row that contradict; one more is a jump
  static constexpr Duration kMaxEarly = std::chrono::milliseconds(20);    ///< a counter may be ahead of arrival by it
  static constexpr Duration kContinuous = std::chrono::milliseconds(20);  ///< shorter steps are no jump of a counter
  static constexpr Duration kMaxDelay = std::chrono::seconds(1);          ///< arrival may go back by it
  static constexpr Duration kQueueDrains = std::chrono::milliseconds(2);  ///< earlier than all before, at the start
  static constexpr Duration kExactTolerance = std::chrono::milliseconds(100);

  /// All firings of a packet begin within this share of its span (the rest is the last sequence's recharge).
  [[nodiscard]] static constexpr Duration busy_share(Duration span) { return span * 63 / 64; }
  /// The lasers of a packet's last firing take at most this share of its span: an HDL-32E in dual mode has six firings.
  [[nodiscard]] static constexpr Duration last_firing_share(Duration span) { return span / 7; }

 private:
  [[nodiscard]] Duration step_from_last(std::uint32_t counter_us, Time arrival) const;
  [[nodiscard]] std::optional<Kind> contradiction(Duration step, Time arrival, Duration sample) const;
  [[nodiscard]] Kind judge(Duration step, Time arrival, Duration sample);
  Stamp follow(Duration step, Time arrival);
  void restart(Kind kind, Time arrival, Duration sample);
  [[nodiscard]] Time last_first_firing() const { return Time{device_ + delay_.offset()}; }

  DelayFilter delay_;  // first firing = device_ + its offset
  Duration device_{};  // sum of the counter's steps
  std::uint32_t counter_us_ = 0;
  Time arrival_{};            // of the last packet, arrival_shift_ included
  Duration arrival_shift_{};  // keeps a broken recording's arrivals from going back
  Duration busy_{};           // time that the last packet's firings take on the robot's time line
  Duration span_{};           // of the last packet, on the device's
  int set_aside_ = 0;         // packets in a row
  bool started_ = false;
  bool may_begin_again_ = true;
  bool stepped_ = false;  // the counter made a long step, and no sample since was near the offset
};

}  // namespace cairn::velodyne
