// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "drivers/drive/can/socket_link.hpp"

namespace cairn::drive {

/// A Linux CAN interface (SocketCAN, raw socket): classic and FD frames, error frames of all classes, receive stamps of
/// the kernel, own frames once they are on the bus.
///
/// Give the interface a short queue. Otherwise a bus without power collects commands and delivers them late:
///   ip link set can0 type can bitrate 500000; ip link set can0 txqueuelen 16; ip link set can0 up
class SocketCanLink final : public SocketLink {
 public:
  /// `clock` must outlive the link. Errors: kNotFound (no such interface), kLinkDown (it is down), kIo, each with the
  /// remedy.
  static Result<std::unique_ptr<SocketCanLink>> open(const std::string& interface, SourceId source, const Clock& clock);

  SendResult send(const CanFrame& frame) override;
  Result<void> restart() override;

 private:
  using SocketLink::SocketLink;
  Result<int> connect() override;
  Result<Poll> receive(Packet& packet) override;

  int index_ = 0;
};

}  // namespace cairn::drive
