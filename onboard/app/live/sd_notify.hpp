// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::app {

/// Tells the service manager how this process is (sd_notify(3)): datagrams to a local socket, without libsystemd.
class SdNotify {
 public:
  /// `socket`: $NOTIFY_SOCKET, a path or "@abstract"; empty: nobody listens, and every notify() succeeds. Errors: kIo,
  /// kInvalidConfig (no such address).
  [[nodiscard]] static Result<SdNotify> open(std::string_view socket);
  SdNotify(SdNotify&& other) noexcept : fd_(other.fd_), address_(std::move(other.address_)) { other.fd_ = -1; }
  SdNotify& operator=(SdNotify&&) = delete;
  SdNotify(const SdNotify&) = delete;
  SdNotify& operator=(const SdNotify&) = delete;
  ~SdNotify();

  /// Lines such as "READY=1" or "WATCHDOG=1\nSTATUS=normal". Never blocks; a full queue is an error (kIo).
  Result<void> notify(std::string_view lines);

 private:
  SdNotify(int fd, std::string address) : fd_(fd), address_(std::move(address)) {}
  int fd_ = -1;
  std::string address_;  // as sockaddr_un::sun_path has it
};

/// $WATCHDOG_USEC, when it is for this process ($WATCHDOG_PID is its own or empty): what the manager waits for a sign
/// of life. None: no watchdog.
[[nodiscard]] std::optional<Duration> watchdog_timeout(std::string_view usec, std::string_view pid, int own_pid);

}  // namespace cairn::app
