// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace cairn::clients {

/// The core's end of a local socket (SOCK_SEQPACKET) with several clients. No call waits, and after open() none
/// allocates: a task with a deadline may use it. What waits for a client is bounded in the kernel.
class LocalServer {
 public:
  /// How a socket is served.
  struct Options {
    std::filesystem::path path;
    std::size_t most_clients = 8;    ///< one more is turned away
    int waiting_bytes = 128 * 1024;  ///< for one client in the kernel; what is more is refused by send()
    /// Whose members may connect, beside the owner. Empty, or not known to the system: the group of the process. If the
    /// process is not in it, the owner alone may connect.
    std::string group{};
  };
  /// Counts connections from 1, so that a number is not used again soon. 0 is no client.
  using ClientId = std::uint16_t;

  /// What receive() found.
  enum class Got : std::uint8_t {
    kNothing,  ///< nobody has sent anything
    kRecord,   ///< `client` sent `bytes` (which are longer than `most` where it sent too much)
    kJoined,   ///< `client` is new
    kLeft,     ///< `client` has gone, or was dropped
  };
  /// One thing that happened, and to whom.
  struct Received {
    Got got = Got::kNothing;
    ClientId client = 0;
  };

  /// Replaces a socket that no process serves any more. Errors: kInvalidConfig (the path is too long), kIo (another
  /// process serves it, the group cannot be given, or the system refused).
  [[nodiscard]] static Result<LocalServer> open(const Options& options);
  LocalServer(LocalServer&& other) noexcept;
  LocalServer& operator=(LocalServer&&) = delete;
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;
  ~LocalServer();

  /// The next thing that happened. Clients take turns, and so do those who want to join. A record is in `bytes`, cut
  /// after `most` + 1 bytes.
  Received receive(std::vector<std::byte>& bytes, std::size_t most);
  /// False: the client is gone, or has not read what was sent before.
  bool send(ClientId client, std::span<const std::byte> message);
  /// The same for what can wait: false also where half of the client's room is taken. The other half is for messages
  /// that cannot wait.
  bool send_bulk(ClientId client, std::span<const std::byte> message);
  /// Ends the connection. The next receive() says that it left.
  void drop(ClientId client);

  [[nodiscard]] std::size_t clients() const { return count_; }
  [[nodiscard]] std::uint64_t turned_away() const { return turned_away_; }

 private:
  struct Client {
    int fd = -1;
    ClientId id = 0;  // 0: the place is free
  };
  LocalServer() = default;
  std::optional<ClientId> accept_one();
  Client* find(ClientId client);
  Received receive_from(Client& client, std::vector<std::byte>& bytes, std::size_t most);
  Received leave(Client& client);

  int listener_ = -1;
  std::filesystem::path path_;
  int waiting_bytes_ = 0;
  std::vector<Client> places_;
  std::size_t turn_ = 0, count_ = 0;
  ClientId last_ = 0;
  std::uint64_t turned_away_ = 0;
};

}  // namespace cairn::clients
