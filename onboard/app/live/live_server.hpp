// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace cairn::app {

/// A local socket that sends the live view to its clients. The watch task serves it, never a real-time thread. No call
/// blocks, and what waits for a client is bounded by kMaxWaiting. A client that cannot take a whole line at once is
/// dropped. When kMaxClients are there, a new one takes the place of the client that has read nothing for longest. If
/// all of them read what they get, the new one is turned away.
class LiveServer {
 public:
  static constexpr std::size_t kMaxClients = 8;
  static constexpr int kMaxWaiting = 128 * 1024;  ///< bytes of lines in the kernel for one client: two of the longest

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
  struct Client {
    int fd;
    std::uint64_t idle_lines;  // lines in a row at which it had not read all that came before
  };
  void accept_clients();
  void take_in(int fd);
  void note_idle();

  int fd_;
  std::filesystem::path path_;
  std::vector<Client> clients_;
  std::uint64_t dropped_ = 0;
};

}  // namespace cairn::app
