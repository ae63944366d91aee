// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// A client's end of robot.sock or command.sock.
class LocalClient {
 public:
  /// Errors: kInvalidConfig (the path is too long), kNotFound (no core serves it), kLimit (many
  /// connect at once: try again), kIo (the system refused, such as a
  /// user who is not in the socket's group).
  [[nodiscard]] static Result<LocalClient> connect(const std::filesystem::path& path);
  LocalClient(LocalClient&& other) noexcept;
  LocalClient& operator=(LocalClient&& other) noexcept;
  LocalClient(const LocalClient&) = delete;
  LocalClient& operator=(const LocalClient&) = delete;
  ~LocalClient();

  /// False: the core has not read what was sent before, or is gone.
  bool send(std::span<const std::byte> message);

  /// What receive() found.
  enum class Got : std::uint8_t {
    kMessage,
    kNothing,  ///< nothing came in time
    kEnd,      ///< the core has gone; connect anew
  };
  /// Waits for the next message, at most `timeout`; it is in `bytes`, cut after `most` + 1 bytes.
  Got receive(std::vector<std::byte>& bytes, std::size_t most, Duration timeout);
  /// Readable when a message has come: for poll().
  [[nodiscard]] int readable_fd() const { return fd_; }

 private:
  explicit LocalClient(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace cairn::clients
