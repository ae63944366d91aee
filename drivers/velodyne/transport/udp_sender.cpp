// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/udp_sender.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace cairn::velodyne {

Result<std::unique_ptr<UdpSender>> UdpSender::open(const std::string& address) {
  in_addr target{};
  if (inet_pton(AF_INET, address.c_str(), &target) != 1)
    return Error{Errc::kInvalidConfig, "not an IPv4 address", address, {}, "such as 127.0.0.1"};
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return Error{Errc::kIo, "cannot make a socket", address, {}, std::strerror(errno)};
  return std::unique_ptr<UdpSender>(new UdpSender(fd, target.s_addr));
}

UdpSender::~UdpSender() { ::close(fd_); }

Result<void> UdpSender::send(std::span<const std::byte> payload, std::uint16_t port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = address_;
  const auto sent = ::sendto(fd_, payload.data(), payload.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  // Nobody listens yet: a sensor does not mind.
  if (sent >= 0 || errno == ECONNREFUSED) return {};
  return Error{Errc::kIo, "cannot send", "port " + std::to_string(port), {}, std::strerror(errno)};
}

}  // namespace cairn::velodyne
