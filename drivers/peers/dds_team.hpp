// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

/// How the peer process takes part in the team's network.
struct DdsConfig {
  std::uint64_t robot = 0;  ///< this one's id
  unsigned domain = 42;
  std::string interface;           ///< name or address of the network interface; empty: the DDS library chooses
  std::vector<std::string> peers;  ///< addresses; nobody else is spoken to, nothing is multicast
  /// As many participants may share a peer's address. Discovery knocks on a port for each, at every teammate, every
  /// two seconds, and where nobody listens the teammate's kernel says so: with four, that was a fifth of what robots
  /// sent (an office, three robots, 160 s: 870-950 kB, 700-720 kB with one).
  unsigned processes_per_host = 1;
  Duration lease = std::chrono::seconds(3);
};

/// The team's topics over Cyclone DDS: best effort, nothing is ever waited for, nothing is kept for others (the
/// exchange above sends again what was lost).
class DdsTeam {
 public:
  /// Errors: kIo with what Cyclone DDS says.
  static Result<std::unique_ptr<DdsTeam>> open(const DdsConfig& config);
  virtual ~DdsTeam() = default;

  /// To one robot, or to all where `to` is 0. What cannot be sent at once is lost.
  virtual Result<void> send(std::uint64_t to, std::span<const std::byte> datagram) = 0;

  /// One datagram of a teammate.
  struct Received {
    std::uint64_t sender = 0;
    std::vector<std::byte> bytes;
  };
  /// Appends what has come, oldest first.
  virtual void receive(std::vector<Received>& out) = 0;
  /// Becomes readable when something has come; to be waited for with poll(). receive() makes it quiet again.
  [[nodiscard]] virtual int readable_fd() const = 0;

 protected:
  DdsTeam() = default;
  DdsTeam(const DdsTeam&) = default;
  DdsTeam& operator=(const DdsTeam&) = default;
};

}  // namespace cairn::peers
