// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace cairn::app {

/// A local socket that sends the live view to its clients. The watch task serves it, never a real-time thread. No call
/// blocks. A client that cannot take a whole line at once is dropped, and so is a client beyond kMaxClients.
class LiveServer {
 public:
  static constexpr std::size_t kMaxClients = 8;

  /// Replaces a socket that no process serves any more. Errors: kInvalidConfig (the path is too long), kIo (another
  /// process serves it, or the system refused).
  [[nodiscard]] static Result<LiveServer> open(const std::filesystem::path& path);
  LiveServer(LiveServer&& other) noexcept;
  LiveServer& operator=(LiveServer&&) = delete;
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;
  ~LiveServer();

  /// Accepts new clients and sends the line to all clients.
  void publish(std::string_view line);
  [[nodiscard]] std::size_t clients() const { return clients_.size(); }
  [[nodiscard]] std::uint64_t dropped_clients() const { return dropped_; }

 private:
  LiveServer(int fd, std::filesystem::path path) : fd_(fd), path_(std::move(path)) {}
  void accept_clients();

  int fd_;
  std::filesystem::path path_;
  std::vector<int> clients_;
  std::uint64_t dropped_ = 0;
};

}  // namespace cairn::app
