// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/socket_link.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "drivers/drive/can/bus_name.hpp"
#include "drivers/drive/can/candump.hpp"
#include "drivers/drive/can/socketcan_link.hpp"
#include "drivers/drive/can/unix_can_link.hpp"

namespace cairn::drive {

Error SocketLink::io_error(std::string_view cause) const {
  return {Errc::kIo, cause, interface_, {}, std::strerror(errno)};
}

SocketLink::~SocketLink() { close(); }

void SocketLink::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

Result<void> SocketLink::connect_now() {
  const auto fd = connect();
  if (!fd) return fd.error();
  fd_ = *fd;
  kernel_drops_ = 0;
  return {};
}

Error SocketLink::lost(int why) {
  close();
  retry_ = kFirstRetry;
  retry_at_ = clock_.now() + retry_;
  return {Errc::kLinkDown, "the CAN interface is down or gone", interface_, {}, std::strerror(why)};
}

void SocketLink::reconnect() {
  if (clock_.now() < retry_at_) return;
  if (connect_now()) {
    ++counters_.reopened;
    return;
  }
  retry_ = std::min(2 * retry_, kLastRetry);
  retry_at_ = clock_.now() + retry_;
}

Result<Poll> SocketLink::next(Packet& packet, Duration timeout) {
  if (!is_open()) reconnect();
  if (is_open()) {
    auto received = receive(packet);
    if (!received || *received == Poll::kPacket || timeout <= Duration::zero()) return received;
  }
  // Without an interface there is nothing to wait for but the time-out: poll ignores a negative descriptor.
  pollfd wait{fd_, POLLIN, 0};
  const auto ns = std::max<std::int64_t>(0, timeout.count());
  const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
  if (ppoll(&wait, 1, &limit, nullptr) <= 0 || !is_open()) return Poll::kTimeout;
  return receive(packet);
}

Result<Poll> SocketLink::receive_message(Packet& packet, int& flags) {
  packet.bytes.resize(kFdBytes);
  iovec part{packet.bytes.data(), packet.bytes.size()};
  alignas(cmsghdr) std::array<std::byte, 128> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(fd_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (size <= 0) {
    packet.bytes.clear();
    if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return Poll::kTimeout;
    return lost(size < 0 ? errno : EPIPE);  // 0: the other end of a connection has closed it
  }
  packet.bytes.resize(static_cast<std::size_t>(size));
  read_stamp(message, packet);
  flags = message.msg_flags;
  packet.truncated = (flags & MSG_TRUNC) != 0;
  return Poll::kPacket;
}

void SocketLink::label(Packet& packet, Direction direction) {
  counters_.own += direction == Direction::kSent ? 1 : 0;
  packet.source = source_;
  packet.channel = static_cast<std::uint16_t>(direction);
  packet.sequence = counters_.delivered++;
  packet.arrival = std::chrono::floor<CandumpTick>(packet.arrival);
}

/// The kernel stamps on CLOCK_REALTIME; a stamp in the future or more than a second back on the monotonic line was made
/// before the wall clock was set.
void SocketLink::read_stamp(msghdr& message, Packet& packet) {
  const Time now = clock_.now();
  packet.arrival = Time::min();
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp;
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      const Duration realtime = std::chrono::seconds(stamp.tv_sec) + std::chrono::nanoseconds(stamp.tv_nsec);
      packet.arrival = Time{realtime - LiveClock::realtime_offset()};
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t drops;
      std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
      counters_.kernel_drops += drops - std::exchange(kernel_drops_, drops);
    }
  }
  constexpr Duration kFuture = std::chrono::milliseconds(1), kPast = std::chrono::seconds(1);
  if (packet.arrival <= now + kFuture && packet.arrival >= now - kPast) return;
  packet.arrival = now;
  ++counters_.unstamped;
}

Result<std::unique_ptr<SocketLink>> open_link(const std::string& interface, SourceId source, const Clock& clock) {
  const auto opened = [](auto link) -> Result<std::unique_ptr<SocketLink>> {
    if (!link) return link.error();
    return std::unique_ptr<SocketLink>(std::move(*link));
  };
  if (is_unix_bus(interface)) return opened(UnixCanLink::open(interface, source, clock));
  return opened(SocketCanLink::open(interface, source, clock));
}

}  // namespace cairn::drive
