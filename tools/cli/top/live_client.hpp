// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::cli {

/// Reads lines from a core's live socket. Bounded in memory, whatever the other end sends.
class LiveClient {
 public:
  /// Errors: kNotFound (no socket: no core runs), kIo, kInvalidConfig (too long a path).
  [[nodiscard]] static Result<LiveClient> connect(const std::filesystem::path& path);
  LiveClient(LiveClient&& other) noexcept : fd_(other.fd_), pending_(std::move(other.pending_)) { other.fd_ = -1; }
  LiveClient& operator=(LiveClient&&) = delete;
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;
  ~LiveClient();

  /// The next whole line without its end; none when nothing came in time. Errors: kLinkDown (the core is gone), kLimit
  /// (no end of a line within LiveView::kMaxLine), kIo.
  [[nodiscard]] Result<std::optional<std::string>> next(Duration timeout);

 private:
  explicit LiveClient(int fd) : fd_(fd) {}
  int fd_;
  std::string pending_;
};

}  // namespace cairn::cli
