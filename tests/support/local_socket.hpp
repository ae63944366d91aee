// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

namespace cairn::support {

/// The address of a local socket; a leading '@' is an abstract one.
class LocalAddress {
 public:
  explicit LocalAddress(const std::string& name) {
    address_.sun_family = AF_UNIX;
    if (name.size() >= sizeof address_.sun_path) throw std::runtime_error("too long: " + name);
    std::memcpy(address_.sun_path, name.data(), name.size());
    if (name[0] == '@') address_.sun_path[0] = '\0';
    length_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  }
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address_); }
  [[nodiscard]] socklen_t length() const { return length_; }

 private:
  sockaddr_un address_{};
  socklen_t length_ = 0;
};

/// Listens for datagrams, as a service manager does.
class DatagramListener {
 public:
  explicit DatagramListener(const std::string& name)
      : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    const LocalAddress address(name);
    if (fd_ < 0 || ::bind(fd_, address.get(), address.length()) != 0) throw std::runtime_error("cannot bind " + name);
  }
  DatagramListener(const DatagramListener&) = delete;
  DatagramListener& operator=(const DatagramListener&) = delete;
  ~DatagramListener() { ::close(fd_); }

  /// The next datagram that is there; empty: none.
  std::string next() {
    std::array<char, 4096> bytes{};
    const ssize_t n = ::recv(fd_, bytes.data(), bytes.size(), 0);
    return n > 0 ? std::string(bytes.data(), static_cast<std::size_t>(n)) : std::string();
  }

 private:
  int fd_;
};

/// Connected to a listening socket.
class StreamClient {
 public:
  explicit StreamClient(const std::string& path) : fd_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const LocalAddress address(path);
    if (::connect(fd_, address.get(), address.length()) != 0) throw std::runtime_error("cannot connect to " + path);
  }
  StreamClient(const StreamClient&) = delete;
  StreamClient& operator=(const StreamClient&) = delete;
  ~StreamClient() { ::close(fd_); }

  /// What is there.
  std::string read() {
    std::string all;
    std::array<char, 65536> bytes{};
    for (ssize_t n; (n = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0;)
      all.append(bytes.data(), static_cast<std::size_t>(n));
    return all;
  }

 private:
  int fd_;
};

/// What a killed server leaves behind: a name that nobody serves.
class AbandonedSocket {
 public:
  explicit AbandonedSocket(const std::string& path) : fd_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const LocalAddress address(path);
    if (::bind(fd_, address.get(), address.length()) != 0) throw std::runtime_error("cannot bind " + path);
  }
  AbandonedSocket(const AbandonedSocket&) = delete;
  AbandonedSocket& operator=(const AbandonedSocket&) = delete;
  ~AbandonedSocket() { ::close(fd_); }

 private:
  int fd_;
};

}  // namespace cairn::support
