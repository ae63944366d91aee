// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/time.hpp"

namespace cairn::velodyne {

/// Lets the kernel drop every datagram that does not come from `address` (IPv4, host byte order). Needs no privilege.
/// Datagrams that wait already stay. False: the kernel refused.
[[nodiscard]] bool admit_only(int socket, std::uint32_t address);
/// Takes that back.
void admit_all(int socket);

/// What the kernel says of a socket's memory.
struct SocketMemory {
  std::uint32_t waiting_bytes = 0;  ///< of datagrams that wait, their bookkeeping included
  std::uint32_t buffer_bytes = 0;   ///< for them at most
  std::uint32_t drops = 0;          ///< datagrams that were dropped since the socket was made, for whatever reason
};
/// None: the kernel does not tell (before Linux 4.12).
[[nodiscard]] std::optional<SocketMemory> socket_memory(int socket);

/// Finds out from which address a sensor sends: the first that has sent kEnough valid packets. A crowd of senders
/// cannot keep one out that sends more than any of them. Pure.
class SenderLearner {
 public:
  static constexpr int kEnough = 20;
  static constexpr Duration kSilent = std::chrono::seconds(1);  ///< of the sensor; it may have a new address then

  /// A datagram from `address` came, and is a packet of the sensor's model or not. Returns the address when it becomes
  /// known.
  std::optional<std::uint32_t> note(std::uint32_t address, bool valid, Time now);
  /// Forgets the address when nothing came from it for kSilent. True if it did.
  bool forget_silent(Time now);
  [[nodiscard]] std::optional<std::uint32_t> address() const { return address_; }

 private:
  struct Candidate {
    std::uint32_t address = 0;
    int packets = 0;
  };
  std::array<Candidate, 8> candidates_{};
  std::optional<std::uint32_t> address_;
  Time last_{};  // packet from address_
};

}  // namespace cairn::velodyne
