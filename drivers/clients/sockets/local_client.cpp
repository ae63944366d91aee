// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/sockets/local_client.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "drivers/clients/sockets/local_address.hpp"

namespace cairn::clients {

Result<LocalClient> LocalClient::connect(const std::filesystem::path& path) {
  const auto address = local_address(path);
  if (!address) return Error{Errc::kInvalidConfig, "no path of a local socket", path.string(), {}, kPathRule};
  LocalClient client(connect_local(*address));
  if (client.fd_ >= 0) return client;
  if (errno == ENOENT || errno == ECONNREFUSED)
    return Error{
        Errc::kNotFound, "no core serves this socket", path.string(), {}, "start one with: cairn run --sockets FOLDER"};
  if (errno == EAGAIN)
    return Error{Errc::kLimit, "many programs connect to the core at once", path.string(), {}, "try again"};
  return local_error("cannot connect to the core", path);
}

LocalClient::LocalClient(LocalClient&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
LocalClient& LocalClient::operator=(LocalClient&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}
LocalClient::~LocalClient() {
  if (fd_ >= 0) ::close(fd_);
}

bool LocalClient::send(std::span<const std::byte> message) {
  return ::send(fd_, message.data(), message.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(message.size());
}

LocalClient::Got LocalClient::receive(std::vector<std::byte>& bytes, std::size_t most, Duration timeout) {
  const auto ms =
      std::chrono::ceil<std::chrono::milliseconds>(std::clamp(timeout, Duration{}, Duration{std::chrono::hours(1)}));
  pollfd readable{.fd = fd_, .events = POLLIN, .revents = 0};
  if (::poll(&readable, 1, static_cast<int>(ms.count())) <= 0) return Got::kNothing;
  bytes.resize(most + 1);
  const ssize_t got = ::recv(fd_, bytes.data(), bytes.size(), 0);
  if (got > 0) {
    bytes.resize(static_cast<std::size_t>(got));
    return Got::kMessage;
  }
  return got < 0 && (errno == EAGAIN || errno == EINTR) ? Got::kNothing : Got::kEnd;
}

}  // namespace cairn::clients
