// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/top/live_client.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "onboard/app/live/live_view.hpp"

namespace cairn::cli {

Result<LiveClient> LiveClient::connect(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.native().size() >= sizeof address.sun_path)
    return Error{Errc::kInvalidConfig, "no path of a local socket", path.string(), {}, "107 bytes at most"};
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  LiveClient client(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (client.fd_ >= 0 && ::connect(client.fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return client;
  const bool nobody = errno == ENOENT || errno == ECONNREFUSED;
  return Error{nobody ? Errc::kNotFound : Errc::kIo,
               nobody ? "no core serves this socket" : "cannot connect",
               path.string(),
               {},
               std::generic_category().message(errno)};
}

LiveClient::~LiveClient() {
  if (fd_ >= 0) ::close(fd_);
}

Result<std::optional<std::string>> LiveClient::next(Duration timeout) {
  for (;;) {
    if (const std::size_t end = pending_.find('\n'); end != std::string::npos) {
      std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      return std::optional(std::move(line));
    }
    if (pending_.size() > app::LiveView::kMaxLine) return Error{Errc::kLimit, "the core sends a line without an end"};
    pollfd waiting{fd_, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(timeout / std::chrono::milliseconds(1)));
    if (ready == 0 || (ready < 0 && errno == EINTR)) return std::optional<std::string>();
    std::array<char, 16384> bytes{};
    const ssize_t n = ready < 0 ? -1 : ::recv(fd_, bytes.data(), bytes.size(), 0);
    if (n == 0) return Error{Errc::kLinkDown, "the core is gone, or dropped a reader that was too slow"};
    if (n < 0) return Error{Errc::kIo, "cannot read", {}, {}, std::generic_category().message(errno)};
    pending_.append(bytes.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace cairn::cli
