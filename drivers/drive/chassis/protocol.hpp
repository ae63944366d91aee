// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "drivers/drive/can/can_frame.hpp"
#include "drivers/drive/can/tx_queue.hpp"
#include "hal/drive.hpp"

namespace cairn::drive {

/// What the motors must do.
struct Order {
  bool enable = false;  ///< false: stop and disable
  bool reset = false;   ///< the drive was just armed: faults may be reset
  bool halt = true;     ///< stay enabled, at rest
  double v = 0, w = 0;  ///< m/s ahead, rad/s to the left; without meaning if `halt`
};

/// The state of the motor controllers.
struct ProtocolStatus {
  bool ready = false;            ///< the motor controllers are configured and wait to be enabled
  bool enabled = false;          ///< all motors carry out orders
  std::optional<Time> feedback;  ///< arrival of the oldest among their newest messages; null: one never sent any
};

/// The protocol of a drive: orders in, frames out; frames in, status out. Pure: no socket, no clock.
class Protocol {
 public:
  virtual ~Protocol() = default;
  /// Takes any frame on the bus. An Error means that the frame was refused whole. Frames of others are ignored.
  virtual Result<void> receive(const CanFrame& frame, Time arrival) = 0;
  /// Queues the frames that are due at `now`. An order to stop comes first in the queue.
  virtual void step(Time now, const Order& order, TxQueue& out) = 0;
  [[nodiscard]] virtual ProtocolStatus status() const = 0;
  /// A fault since the last call, or kNone.
  virtual DriveCause take_fault() = 0;

 protected:
  Protocol() = default;
  Protocol(const Protocol&) = default;
  Protocol& operator=(const Protocol&) = default;
};

}  // namespace cairn::drive
