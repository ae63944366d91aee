// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"
#include "tools/team/network/radio.hpp"

namespace cairn::team_run {

/// Each robot's network, and the radio that joins them.
class Network {
 public:
  virtual ~Network() = default;

  /// What it is made of, for people.
  [[nodiscard]] virtual std::string_view kind() const = 0;
  /// The network namespace of a robot's processes; −1: it has none of its own.
  [[nodiscard]] virtual int namespace_of(Index robot) const = 0;
  /// The arguments of the robot's peer process: interface, teammates, and the local socket as seen from its folder.
  [[nodiscard]] virtual std::vector<std::string> peer_arguments(Index robot) const = 0;
  /// Appends the files that become readable when there is something to pump.
  virtual void add_waits(std::vector<pollfd>& waits) const = 0;
  /// Takes what robots have sent, and hands out what has arrived.
  virtual void pump(Time now) = 0;
  [[nodiscard]] virtual const Radio& radio() const = 0;

 protected:
  Network() = default;
  Network(const Network&) = default;
  Network& operator=(const Network&) = default;
};

/// The core's local socket in its robot's folder.
inline constexpr const char* kCoreSocket = "peers.sock";

/// TUN devices in network namespaces: the radio reads every IP packet that a robot sends. This needs root, or a user
/// namespace and a /dev/net/tun that every user may open. Errors: kIo, with what the system refused.
Result<std::unique_ptr<Network>> make_tun_network(const LinkConfig& link, Index robots);

/// For machines that allow no network namespaces. The robots' peer processes meet on this machine's loopback, and the
/// radio stands at the local socket between each of them and its core. Bytes are those of the datagrams, without
/// headers. `folders` are the robots'. Errors: kIo, kLimit (more robots than can share one address).
Result<std::unique_ptr<Network>> make_loopback_network(const LinkConfig& link,
                                                       const std::vector<std::filesystem::path>& folders);

}  // namespace cairn::team_run
