// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "drivers/drive/can/can_frame.hpp"
#include "hal/time.hpp"

namespace cairn::drive {

/// Error classes in the identifier of an error frame, and details in its data (linux/can/error.h).
inline constexpr std::uint32_t kErrorController = 0x004, kErrorNoAck = 0x020, kErrorBusOff = 0x040,
                               kErrorRestarted = 0x100;
inline constexpr std::uint8_t kControllerWarning = 0x0C, kControllerPassive = 0x30,
                              kControllerActive = 0x40;  // data[1]

/// What sending a frame came to.
enum class SendResult : std::uint8_t {
  kSent,
  kQueueFull,  ///< ENOBUFS or EAGAIN: the interface's queue is full
  kDown,       ///< the interface is down or gone
};

/// The state of the link to a bus, from error frames and from the results of sending. After a bus-off it asks for a
/// restart of the controller 0.1, 0.5 and 2 s later, and then gives up (kFailed). Pure.
class LinkMonitor {
 public:
  enum class State : std::uint8_t { kUp, kErrorPassive, kBusOff, kFailed, kDown };
  /// What was seen on the bus.
  struct Counters {
    std::uint64_t error_frames = 0, bus_offs = 0, passives = 0, warnings = 0, no_acks = 0, queue_fulls = 0;
  };
  static constexpr int kFullInARow = 3, kRestarts = 3;
  static constexpr Duration kRestartAfter[kRestarts] = {std::chrono::milliseconds(100), std::chrono::milliseconds(500),
                                                        std::chrono::seconds(2)};

  /// Takes any received frame. An ordinary frame proves that the bus works again.
  void receive(const CanFrame& frame, Time arrival);
  /// Takes the result of sending a frame.
  void sent(SendResult result);
  /// True when the controller should be restarted now.
  bool step(Time now);
  /// An operator wants another try after kFailed.
  void retry(Time now);

  [[nodiscard]] State state() const { return down_ ? State::kDown : state_; }
  [[nodiscard]] bool queue_full() const { return full_in_a_row_ >= kFullInARow; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  void controller(std::uint8_t detail);
  void bus_off(Time now);

  State state_ = State::kUp;
  bool down_ = false;
  int full_in_a_row_ = 0;
  int restarts_ = 0;
  Time next_restart_{};
  Counters counters_;
};

}  // namespace cairn::drive
