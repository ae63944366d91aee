// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/sockets/local_server.hpp"

#include <grp.h>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "drivers/clients/sockets/local_address.hpp"

namespace cairn::clients {
namespace {

constexpr ::mode_t kOwnerAndGroup = 0660, kOwner = 0600;
constexpr int kBacklog = 64;

/// Gives the socket to a group that the system knows. Who is not in it may not give it: then the owner alone gets in.
bool share(const std::filesystem::path& path, const std::string& group) {
  if (!group.empty())
    if (const ::group* known = ::getgrnam(group.c_str()); known != nullptr)
      if (::chown(path.c_str(), static_cast<::uid_t>(-1), known->gr_gid) != 0) return errno == EPERM;
  return ::chmod(path.c_str(), kOwnerAndGroup) == 0;
}

}  // namespace

Result<LocalServer> LocalServer::open(const Options& options) {
  const auto& path = options.path;
  const auto address = local_address(path);
  if (!address) return Error{Errc::kInvalidConfig, "no path for a local socket", path.string(), {}, kPathRule};
  if (const int other = connect_local(*address); other >= 0) {
    ::close(other);
    return Error{Errc::kIo, "another process serves this socket", path.string(), {}, {}};
  }
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && S_ISSOCK(there.st_mode)) ::unlink(path.c_str());
  LocalServer server;
  server.listener_ = ::socket(AF_UNIX, kLocalType, 0);
  if (server.listener_ < 0) return local_error("cannot make a socket", path);
  if (::bind(server.listener_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0)
    return local_error("cannot bind the socket", path);
  server.path_ = path;
  if (::chmod(path.c_str(), kOwner) != 0 || !share(path, options.group))
    return local_error("cannot give the socket to its group", path);
  if (::listen(server.listener_, kBacklog) != 0) return local_error("cannot listen on the socket", path);
  server.waiting_bytes_ = options.waiting_bytes;
  server.places_.resize(options.most_clients);
  return server;
}

LocalServer::LocalServer(LocalServer&& other) noexcept
    : listener_(std::exchange(other.listener_, -1)),
      path_(std::exchange(other.path_, {})),
      waiting_bytes_(other.waiting_bytes_),
      places_(std::exchange(other.places_, {})),
      turn_(other.turn_),
      count_(other.count_),
      last_(other.last_),
      turned_away_(other.turned_away_) {}

LocalServer::~LocalServer() {
  for (const Client& client : places_)
    if (client.fd >= 0) ::close(client.fd);
  if (listener_ >= 0) ::close(listener_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

LocalServer::Client* LocalServer::find(ClientId client) {
  for (Client& place : places_)
    if (place.id == client && client != 0) return &place;
  return nullptr;
}

std::optional<LocalServer::ClientId> LocalServer::accept_one() {
  const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) return std::nullopt;
  for (Client& place : places_) {
    if (place.id != 0) continue;
    (void)::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &waiting_bytes_, sizeof waiting_bytes_);
    do ++last_;
    while (last_ == 0 || find(last_) != nullptr);
    place = {fd, last_};
    ++count_;
    return last_;
  }
  ++turned_away_;
  ::close(fd);
  return std::nullopt;
}

LocalServer::Received LocalServer::leave(Client& client) {
  if (client.fd >= 0) ::close(client.fd);
  --count_;
  return {Got::kLeft, std::exchange(client, {}).id};
}

LocalServer::Received LocalServer::receive_from(Client& client, std::vector<std::byte>& bytes, std::size_t most) {
  if (client.fd < 0) return leave(client);  // it was dropped
  bytes.resize(most + 1);                   // one more: a longer one shows
  const ssize_t got = ::recv(client.fd, bytes.data(), bytes.size(), 0);
  if (got > 0) {
    bytes.resize(static_cast<std::size_t>(got));
    return {Got::kRecord, client.id};
  }
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  return leave(client);  // an empty message, too, is the end
}

LocalServer::Received LocalServer::receive(std::vector<std::byte>& bytes, std::size_t most) {
  for (std::size_t i = 0; i <= places_.size(); ++i) {
    const std::size_t turn = turn_;
    turn_ = (turn_ + 1) % (places_.size() + 1);
    if (turn == places_.size()) {
      if (const auto joined = accept_one()) return {Got::kJoined, *joined};
    } else if (places_[turn].id != 0) {
      const Received received = receive_from(places_[turn], bytes, most);
      if (received.got != Got::kNothing) return received;
    }
  }
  return {};
}

bool LocalServer::send(ClientId client, std::span<const std::byte> message) {
  const Client* place = find(client);
  return place != nullptr && place->fd >= 0 &&
         ::send(place->fd, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
             static_cast<ssize_t>(message.size());
}

/// The kernel takes twice `waiting_bytes`, and counts its own overhead.
bool LocalServer::send_bulk(ClientId client, std::span<const std::byte> message) {
  const Client* place = find(client);
  int waiting = 0;
  if (place == nullptr || place->fd < 0 || ::ioctl(place->fd, SIOCOUTQ, &waiting) != 0) return false;
  if (waiting > 0 && waiting + static_cast<int>(message.size()) > waiting_bytes_) return false;
  return send(client, message);
}

void LocalServer::drop(ClientId client) {
  Client* place = find(client);
  if (place == nullptr || place->fd < 0) return;
  ::close(place->fd);
  place->fd = -1;
}

}  // namespace cairn::clients
