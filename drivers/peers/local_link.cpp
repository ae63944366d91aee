// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/local_link.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

namespace cairn::peer_link {
namespace {

constexpr int kType = SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK;

Error refused(std::string_view cause, const std::filesystem::path& path) {
  return {Errc::kIo, cause, path.string(), {}, std::generic_category().message(errno)};
}

std::optional<sockaddr_un> address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.native().size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  return address;
}

/// A connection, or −1.
int connected(const sockaddr_un& address) {
  const int fd = ::socket(AF_UNIX, kType, 0);
  if (fd >= 0 && ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  if (fd >= 0) ::close(fd);
  return -1;
}

}  // namespace

Result<LocalLink> LocalLink::listen(const std::filesystem::path& path) {
  const auto address = address_of(path);
  if (!address)
    return Error{Errc::kInvalidConfig, "no path for a local socket", path.string(), {}, "107 bytes at most"};
  if (const int other = connected(*address); other >= 0) {
    ::close(other);
    return Error{Errc::kIo, "another core serves this socket", path.string(), {}, {}};
  }
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && S_ISSOCK(there.st_mode)) ::unlink(path.c_str());
  LocalLink link(path, ::socket(AF_UNIX, kType, 0));
  if (link.listener_ < 0) return refused("cannot make a socket", path);
  constexpr ::mode_t kOwnerAndGroup = 0660;
  if (::bind(link.listener_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0 ||
      ::chmod(path.c_str(), kOwnerAndGroup) != 0 || ::listen(link.listener_, 1) != 0)
    return refused("cannot serve the socket", path);
  return link;
}

LocalLink LocalLink::connect(std::filesystem::path path) { return {std::move(path), -1}; }

LocalLink::LocalLink(LocalLink&& other) noexcept
    : path_(std::move(other.path_)),
      listener_(std::exchange(other.listener_, -1)),
      fd_(std::exchange(other.fd_, -1)),
      counters_(other.counters_) {}

LocalLink::~LocalLink() {
  drop();
  if (listener_ < 0) return;
  ::close(listener_);
  ::unlink(path_.c_str());
}

void LocalLink::drop() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

bool LocalLink::join() {
  if (fd_ >= 0) return true;
  if (listener_ >= 0) {
    fd_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd_ < 0) return false;
    // What waits for a capped link grows old: some thirty datagrams, a second or two of it.
    constexpr int kWaitingBytes = 48 * 1024;
    (void)::setsockopt(fd_, SOL_SOCKET, SO_SNDBUF, &kWaitingBytes, sizeof kWaitingBytes);
  } else {
    const auto address = address_of(path_);
    fd_ = address ? connected(*address) : -1;
    if (fd_ < 0) return false;
  }
  ++counters_.connections;
  return true;
}

bool LocalLink::send(const LinkFrame& frame) {
  if (fd_ >= 0) {
    encode(frame, out_);
    if (::send(fd_, out_.data(), out_.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(out_.size())) {
      ++counters_.sent;
      return true;
    }
  }
  ++counters_.lost;
  return false;
}

bool LocalLink::receive(std::vector<std::byte>& memory, LinkFrame& frame) {
  while (fd_ >= 0) {
    memory.resize(LinkFrame::kHeaderBytes + LinkFrame::kMaxBytes + 1);  // one more: a longer one shows
    const ssize_t got = ::recv(fd_, memory.data(), memory.size(), 0);
    if (got <= 0) {
      if (got != 0 && (errno == EAGAIN || errno == EINTR)) return false;
      drop();
      if (listener_ >= 0 && join()) continue;  // the one that came after it
      return false;
    }
    memory.resize(static_cast<std::size_t>(got));
    const auto decoded = decode_link_frame(memory);
    if (!decoded) {
      ++counters_.refused;
      continue;
    }
    ++counters_.received;
    frame = *decoded;
    return true;
  }
  return false;
}

}  // namespace cairn::peer_link
