// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/sd_notify.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <system_error>

namespace cairn::app {
namespace {

template <class T>
std::optional<T> whole_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Result<SdNotify> SdNotify::open(std::string_view socket) {
  if (socket.empty()) return SdNotify(-1, {});
  std::string address(socket);
  const bool known = (address[0] == '/' || address[0] == '@') && address.size() > 1;
  if (!known || address.size() >= sizeof(sockaddr_un::sun_path))
    return Error{Errc::kInvalidConfig, "no address of a local socket", "NOTIFY_SOCKET", {}, address};
  if (address[0] == '@') address[0] = '\0';
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0)
    return Error{Errc::kIo, "cannot make a socket", "NOTIFY_SOCKET", {}, std::generic_category().message(errno)};
  return SdNotify(fd, std::move(address));
}

SdNotify::~SdNotify() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> SdNotify::notify(std::string_view lines) {
  if (fd_ < 0) return {};
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  std::memcpy(to.sun_path, address_.data(), address_.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  const auto* address = reinterpret_cast<const sockaddr*>(&to);
  if (::sendto(fd_, lines.data(), lines.size(), MSG_NOSIGNAL, address, length) >= 0) return {};
  return Error{
      Errc::kIo, "the service manager cannot be told", "NOTIFY_SOCKET", {}, std::generic_category().message(errno)};
}

std::optional<Duration> watchdog_timeout(std::string_view usec, std::string_view pid, int own_pid) {
  if (!pid.empty() && whole_number<int>(pid) != own_pid) return std::nullopt;
  const auto timeout = whole_number<std::int64_t>(usec);
  constexpr std::int64_t kDay = 86'400'000'000;
  if (!timeout || *timeout <= 0 || *timeout > kDay) return std::nullopt;
  return std::chrono::microseconds(*timeout);
}

}  // namespace cairn::app
