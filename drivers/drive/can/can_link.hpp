// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/drive/can/can_frame.hpp"
#include "drivers/drive/can/link_monitor.hpp"
#include "hal/ports.hpp"

namespace cairn::drive {

/// A CAN bus that frames can be received from and sent to. next() gives frames in the form of decode_frame(). Own
/// frames are included once the controller has sent them: Packet::channel is a Direction.
class CanLink : public Source {
 public:
  /// Sends a frame. Never waits.
  virtual SendResult send(const CanFrame& frame) = 0;
  /// Asks the system to restart a controller that is bus-off. Error kIo: no permission (CAP_NET_ADMIN), or it failed.
  virtual Result<void> restart() = 0;

 protected:
  CanLink() = default;
};

}  // namespace cairn::drive
