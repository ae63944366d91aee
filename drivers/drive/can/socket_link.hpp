// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/drive/can/can_link.hpp"
#include "hal/clock.hpp"

struct msghdr;

namespace cairn::drive {

/// A CAN bus behind a socket. Never waits longer than asked. If the socket is lost, it is opened again by name, after
/// 0.1 … 2 s. Allocates nothing once the packet has grown.
class SocketLink : public CanLink {
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

  SocketLink(const SocketLink&) = delete;
  SocketLink& operator=(const SocketLink&) = delete;
  ~SocketLink() override;

  /// Error kLinkDown once when the link is lost. Then kTimeout until it is open again.
  Result<Poll> next(Packet& packet, Duration timeout) final;

  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 protected:
  SocketLink(std::string interface, SourceId source, const Clock& clock)
      : interface_(std::move(interface)), clock_(clock), source_(source) {}

  /// A descriptor that never blocks, ready to receive from.
  virtual Result<int> connect() = 0;
  /// kTimeout: nothing is there.
  virtual Result<Poll> receive(Packet& packet) = 0;

  /// Opens the socket.
  Result<void> connect_now();
  void close();
  /// The link is gone: closes it and plans the next try. `why`: an errno.
  Error lost(int why);
  /// The next message on the socket, unlabelled; `flags`: those of recvmsg.
  Result<Poll> receive_message(Packet& packet, int& flags);
  /// What every packet of this link says of itself.
  void label(Packet& packet, Direction direction);
  [[nodiscard]] Error io_error(std::string_view cause) const;  ///< of the present errno

  std::string interface_;
  const Clock& clock_;
  int fd_ = -1;
  Counters counters_;

 private:
  void reconnect();
  void read_stamp(msghdr& message, Packet& packet);

  SourceId source_;
  std::uint32_t kernel_drops_ = 0;
  Time retry_at_{};
  Duration retry_ = kFirstRetry;
};

/// The bus that `interface` names: a SocketCAN interface, or unix:PATH, a bus that another program plays on this
/// machine. `clock` must outlive the link. Errors: those of SocketCanLink::open() and UnixCanLink::open().
Result<std::unique_ptr<SocketLink>> open_link(const std::string& interface, SourceId source, const Clock& clock);

}  // namespace cairn::drive
