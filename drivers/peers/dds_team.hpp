// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::peer_link {

/// How the peer process takes part in the team's network.
struct DdsConfig {
  std::uint64_t robot = 0;  ///< this one's id
  unsigned domain = 42;
  std::string interface;           ///< name or address of the network interface; empty: the DDS library chooses
  std::vector<std::string> peers;  ///< addresses of the teammates; nothing is sent to others, or multicast
  /// How many participants may share a peer's address. Discovery sends to one port for each, at every teammate, every
  /// two seconds. If nobody listens there, the teammate's kernel answers. With four, this was a fifth of all traffic
  /// (an office, three robots, 160 s: 870-950 kB; 700-720 kB with one).
  unsigned processes_per_host = 1;
  Duration lease = std::chrono::seconds(3);  ///< a teammate that was not heard for so long is lost
};

/// The team's topic over Cyclone DDS, best effort: it never waits, and keeps nothing to send it again. The exchange
/// above sends again what was lost.
class DdsTeam {
 public:
  /// Errors: kIo with what Cyclone DDS says.
  static Result<std::unique_ptr<DdsTeam>> open(const DdsConfig& config);
  virtual ~DdsTeam() = default;

  /// Sends to one robot, or to all if `to` is 0. What cannot be sent at once is lost. Errors: kIo.
  virtual Result<void> send(std::uint64_t to, std::span<const std::byte> datagram) = 0;

  /// One datagram of a teammate.
  struct Received {
    std::uint64_t sender = 0;
    std::vector<std::byte> bytes;
  };
  /// Appends what has come, oldest first.
  virtual void receive(std::vector<Received>& out) = 0;
  /// Becomes readable when something has come: wait for it with poll(). It is quiet again after receive().
  [[nodiscard]] virtual int readable_fd() const = 0;

 protected:
  DdsTeam() = default;
  DdsTeam(const DdsTeam&) = default;
  DdsTeam& operator=(const DdsTeam&) = default;
};

}  // namespace cairn::peer_link
