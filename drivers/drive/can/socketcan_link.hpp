// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/drive/can/can_link.hpp"
#include "hal/clock.hpp"

struct msghdr;

namespace cairn::drive {

/// A Linux CAN interface (SocketCAN, raw socket): classic and FD frames, error frames of all classes, receive stamps of
/// the kernel, own frames once they are on the bus. Never waits longer than asked. If the interface goes down or
/// disappears, it is opened again by name, after 0.1 … 2 s. Allocates nothing once the packet has grown.
///
/// Give the interface a short queue. Otherwise a bus without power collects commands and delivers them late:
///   ip link set can0 type can bitrate 500000; ip link set can0 txqueuelen 16; ip link set can0 up
class SocketCanLink final : public CanLink {
 public:
  /// What happened to the frames and to the interface.
  struct Counters {
    std::uint64_t delivered = 0;     ///< as packets: received and own
    std::uint64_t own = 0;           ///< of those, sent by this socket
    std::uint64_t unstamped = 0;     ///< without a usable kernel stamp: stamped when read
    std::uint64_t kernel_drops = 0;  ///< the receive buffer was full
    std::uint64_t reopened = 0;
  };
  static constexpr Duration kFirstRetry = std::chrono::milliseconds(100), kLastRetry = std::chrono::seconds(2);

  /// `clock` must outlive the link. Errors: kNotFound (no such interface), kLinkDown (it is down), kIo, each with the
  /// remedy.
  static Result<std::unique_ptr<SocketCanLink>> open(const std::string& interface, SourceId source, const Clock& clock);
  SocketCanLink(const SocketCanLink&) = delete;
  SocketCanLink& operator=(const SocketCanLink&) = delete;
  ~SocketCanLink() override;

  /// Error kLinkDown once when the link is lost. Then kTimeout until it is open again.
  Result<Poll> next(Packet& packet, Duration timeout) override;
  SendResult send(const CanFrame& frame) override;
  Result<void> restart() override;

  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  SocketCanLink(std::string interface, SourceId source, const Clock& clock)
      : interface_(std::move(interface)), source_(source), clock_(clock) {}
  Result<void> connect();
  void reconnect();
  void close();
  Error lost(int why);
  Result<Poll> receive(Packet& packet);
  void read_stamp(msghdr& message, Packet& packet);

  std::string interface_;
  SourceId source_;
  const Clock& clock_;
  int fd_ = -1;
  int index_ = 0;
  std::uint32_t kernel_drops_ = 0;
  Time retry_at_{};
  Duration retry_ = kFirstRetry;
  Counters counters_;
};

}  // namespace cairn::drive
