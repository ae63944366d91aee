// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/unix_can_link.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/drive/can/bus_name.hpp"

namespace cairn::drive {
namespace {

// A core that ticks while the other program sleeps for some milliseconds finds room; old commands do not pile up.
constexpr int kSendBuffer = 16 * 1024;

constexpr const char* kRemedy = "; start the program that plays the bus first: cairn simulate --live";

void prepare(int fd) {
  constexpr int kOn = 1;
  setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &kOn, sizeof kOn);
  setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
}

}  // namespace

Result<std::unique_ptr<UnixCanLink>> UnixCanLink::open(const std::string& interface, SourceId source,
                                                       const Clock& clock) {
  std::unique_ptr<UnixCanLink> made(new UnixCanLink(interface, source, clock));
  if (auto opened = made->connect_now(); !opened) return opened.error();
  return made;
}

std::unique_ptr<UnixCanLink> UnixCanLink::adopt(int fd, SourceId source, const Clock& clock) {
  std::unique_ptr<UnixCanLink> made(new UnixCanLink("a connection", source, clock));
  prepare(fd);
  made->fd_ = fd;
  made->adopted_ = true;
  return made;
}

Result<int> UnixCanLink::connect() {
  if (adopted_) return Error{Errc::kLinkDown, "the connection has ended", interface_, {}, {}};
  const auto path = path_of_unix_bus(interface_);
  if (!path) return path.error();
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return io_error("cannot make a socket for the CAN bus");
  prepare(fd);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path->copy(address.sun_path, sizeof address.sun_path - 1);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    own_size_ = 0;
    return fd;
  }
  Error error = io_error("nobody plays this CAN bus");
  if (errno == ENOENT || errno == ECONNREFUSED) {
    error.code = Errc::kNotFound;
    error.detail += kRemedy;
  }
  ::close(fd);
  return error;
}

Result<Poll> UnixCanLink::receive(Packet& packet) {
  if (own_size_ > 0) {
    give_own(packet);
    return Poll::kPacket;
  }
  int flags = 0;
  const auto received = receive_message(packet, flags);
  if (received && *received == Poll::kPacket) label(packet, Direction::kReceived);
  return received;
}

void UnixCanLink::give_own(Packet& packet) {
  const Own& own = own_.at(own_first_);
  encode_frame(own.frame, packet);
  packet.arrival = own.sent;
  packet.truncated = false;
  own_first_ = (own_first_ + 1) % kMostOwn;
  --own_size_;
  label(packet, Direction::kSent);
}

SendResult UnixCanLink::send(const CanFrame& frame) {
  if (!is_open()) return SendResult::kDown;
  if (own_size_ == kMostOwn) return SendResult::kQueueFull;
  encode_frame(frame, outgoing_);
  const std::size_t size = outgoing_.bytes.size();
  if (::send(fd_, outgoing_.bytes.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(size)) {
    own_.at((own_first_ + own_size_++) % kMostOwn) = {frame, clock_.now()};
    return SendResult::kSent;
  }
  if (errno == ENOBUFS || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return SendResult::kQueueFull;
  return SendResult::kDown;  // next() finds out, closes and opens again
}

}  // namespace cairn::drive
