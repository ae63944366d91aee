// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "drivers/drive/can/socket_link.hpp"

namespace cairn::drive {

/// A bus that another program of this machine plays, where the kernel has no CAN: a Unix socket (SOCK_SEQPACKET) whose
/// records are frames in the form of decode_frame(), each way. `cairn simulate --live` plays such a bus.
///
/// There is no controller that confirms what was sent. A frame counts as sent when the socket has taken it.
class UnixCanLink final : public SocketLink {
 public:
  /// `interface`: unix:PATH, see bus_name.hpp. `clock` must outlive the link. Errors: kInvalidConfig (no such name),
  /// kNotFound (nobody plays that bus), kIo, each with the remedy.
  static Result<std::unique_ptr<UnixCanLink>> open(const std::string& interface, SourceId source, const Clock& clock);

  /// The end of the program that plays the bus: a connection that it has accepted. It is not opened again.
  static std::unique_ptr<UnixCanLink> adopt(int fd, SourceId source, const Clock& clock);

  /// kQueueFull: the other program does not read, or next() has not been called for kMostOwn frames.
  SendResult send(const CanFrame& frame) override;
  /// Nothing: such a bus has no controller that could be bus-off.
  Result<void> restart() override { return {}; }

  static constexpr std::size_t kMostOwn = 64;  ///< sent frames that wait for next()

 private:
  using SocketLink::SocketLink;
  Result<int> connect() override;
  Result<Poll> receive(Packet& packet) override;
  void give_own(Packet& packet);

  struct Own {
    CanFrame frame;
    Time sent{};
  };
  std::array<Own, kMostOwn> own_{};
  std::size_t own_first_ = 0, own_size_ = 0;
  Packet outgoing_;
  bool adopted_ = false;
};

}  // namespace cairn::drive
