// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace cairn::app {

/// A local socket that tells whoever listens how the run goes. Served by the watch task, never by a real-time thread;
/// no call blocks. A client that cannot take a whole line at once is dropped, and so is one beyond kMaxClients.
class LiveServer {
 public:
  static constexpr std::size_t kMaxClients = 8;

  /// Replaces a socket that nobody serves any more. Errors: kInvalidConfig (too long a path), kIo (somebody serves it,
  /// or the system refused).
  [[nodiscard]] static Result<LiveServer> open(const std::filesystem::path& path);
  LiveServer(LiveServer&& other) noexcept;
  LiveServer& operator=(LiveServer&&) = delete;
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;
  ~LiveServer();

  /// Takes new clients in and sends them all the line.
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
