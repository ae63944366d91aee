// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/live_server.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace cairn::app {
namespace {

Error socket_error(std::string_view cause, const std::filesystem::path& path) {
  return {Errc::kIo, cause, path.string(), {}, std::generic_category().message(errno)};
}

/// Whether a process listens there.
bool is_served(const sockaddr_un& address) {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return false;
  const bool served =
      ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 || errno == EAGAIN;
  ::close(fd);
  return served;
}

/// Whether something that was sent waits to be read.
bool has_unread(int fd) {
  constexpr std::size_t kSentAndUnread = 2, kValues = 16;  // SK_MEMINFO_WMEM_ALLOC of <linux/sock_diag.h>
  std::array<std::uint32_t, kValues> memory{};
  socklen_t size = sizeof memory;
  return ::getsockopt(fd, SOL_SOCKET, SO_MEMINFO, memory.data(), &size) == 0 && memory[kSentAndUnread] > 0;
}

}  // namespace

Result<LiveServer> LiveServer::open(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.native().size() >= sizeof address.sun_path)
    return Error{Errc::kInvalidConfig, "no path for a local socket", path.string(), {}, "107 bytes at most"};
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  if (is_served(address)) return Error{Errc::kIo, "another process serves this socket", path.string(), {}, {}};
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && S_ISSOCK(there.st_mode)) ::unlink(path.c_str());
  LiveServer server(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0), {});
  if (server.fd_ < 0) return socket_error("cannot make a socket", path);
  if (::bind(server.fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return socket_error("cannot bind the socket", path);
  server.path_ = path;
  constexpr ::mode_t kOwnerAndGroup = 0660;
  if (::chmod(path.c_str(), kOwnerAndGroup) != 0 || ::listen(server.fd_, static_cast<int>(kMaxClients)) != 0)
    return socket_error("cannot listen on the socket", path);
  server.clients_.reserve(kMaxClients);
  return server;
}

LiveServer::LiveServer(LiveServer&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      path_(std::exchange(other.path_, {})),
      clients_(std::exchange(other.clients_, {})),
      dropped_(other.dropped_) {}

LiveServer::~LiveServer() {
  for (const Client& client : clients_) ::close(client.fd);
  if (fd_ >= 0) ::close(fd_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

void LiveServer::accept_clients() {
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    const int client = ::accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (client < 0) return;
    take_in(client);
  }
}

void LiveServer::take_in(int fd) {
  (void)::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kMaxWaiting, sizeof kMaxWaiting);
  if (clients_.size() < kMaxClients) return clients_.push_back({fd, 0});
  const auto idlest = std::ranges::max_element(clients_, {}, &Client::idle_lines);
  ++dropped_;
  if (idlest->idle_lines == 0) {
    ::close(fd);
    return;
  }
  ::close(idlest->fd);
  *idlest = {fd, 0};
}

void LiveServer::note_idle() {
  for (Client& client : clients_) {
    client.idle_lines = has_unread(client.fd) ? client.idle_lines + 1 : 0;
  }
}

void LiveServer::publish(std::string_view line) {
  note_idle();
  accept_clients();
  std::size_t kept = 0;
  for (const Client& client : clients_) {
    const ssize_t sent = ::send(client.fd, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent == static_cast<ssize_t>(line.size())) {
      clients_[kept++] = client;
    } else {
      ::close(client.fd);
      ++dropped_;
    }
  }
  clients_.resize(kept);
}

}  // namespace cairn::app
