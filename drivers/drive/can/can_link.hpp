// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/drive/can/can_frame.hpp"
#include "drivers/drive/can/link_monitor.hpp"
#include "hal/ports.hpp"

namespace cairn::drive {

/// A CAN bus that can be heard and spoken to. next() gives frames as decode_frame() takes them, own ones included once
/// the controller has sent them (Packet::channel is a Direction).
class CanLink : public Source {
 public:
  /// Never waits.
  virtual SendResult send(const CanFrame& frame) = 0;
  /// Asks the system to restart a controller that is bus-off. Error: it may not (CAP_NET_ADMIN) or cannot.
  virtual Result<void> restart() = 0;

 protected:
  CanLink() = default;
};

}  // namespace cairn::drive
