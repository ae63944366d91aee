// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/socketcan_link.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "drivers/drive/can/socketcan_restart.hpp"

namespace cairn::drive {

static_assert(sizeof(can_frame) == kClassicBytes && sizeof(canfd_frame) == kFdBytes, "Packet bytes are the kernel's");
static_assert(CAN_EFF_FLAG == kExtended && CAN_RTR_FLAG == kRemote && CAN_ERR_FLAG == kErrorFrame);
static_assert(CAN_ERR_CRTL == kErrorController && CAN_ERR_ACK == kErrorNoAck && CAN_ERR_BUSOFF == kErrorBusOff &&
              CAN_ERR_RESTARTED == kErrorRestarted);

namespace {

Error io_error(std::string_view cause, const std::string& interface) {
  return {Errc::kIo, cause, interface, {}, std::strerror(errno)};
}

bool set_option(int fd, int level, int option, int value) {
  return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

/// Stamps, drop counts, error frames and own frames on; FD where the kernel has it; a short send buffer.
bool set_options(int fd) {
  const can_err_mask_t all_errors = CAN_ERR_MASK;
  const bool errors = setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &all_errors, sizeof all_errors) == 0;
  set_option(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1);
  constexpr int kSmallest = 1;  // the kernel raises it to its minimum: a few frames
  set_option(fd, SOL_SOCKET, SO_SNDBUF, kSmallest);
  set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1);
  return errors && set_option(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1) &&
         set_option(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1);
}

}  // namespace

Result<std::unique_ptr<SocketCanLink>> SocketCanLink::open(const std::string& interface, SourceId source,
                                                           const Clock& clock) {
  std::unique_ptr<SocketCanLink> made(new SocketCanLink(interface, source, clock));
  if (auto connected = made->connect(); !connected) return connected.error();
  return made;
}

SocketCanLink::~SocketCanLink() { close(); }

void SocketCanLink::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

Result<void> SocketCanLink::connect() {
  if (interface_.empty() || interface_.size() >= IFNAMSIZ)
    return Error{Errc::kInvalidConfig, "no name of an interface", interface_, {}, {}};
  fd_ = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (fd_ < 0) {
    Error error = io_error("cannot make a CAN socket", interface_);
    if (errno == EAFNOSUPPORT) error.detail += "; load the module: modprobe can-raw";
    return error;
  }
  const auto refuse = [&](Error error) {
    close();
    return error;
  };
  ifreq request{};
  interface_.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(fd_, SIOCGIFINDEX, &request) != 0)
    return refuse({Errc::kNotFound, "no such interface", interface_, {}, "ip -brief link shows which there are"});
  index_ = request.ifr_ifindex;
  if (ioctl(fd_, SIOCGIFFLAGS, &request) != 0) return refuse(io_error("cannot ask for the interface", interface_));
  if ((request.ifr_flags & IFF_UP) == 0)
    return refuse({Errc::kLinkDown, "the interface is down", interface_, {}, "ip link set " + interface_ + " up"});
  if (!set_options(fd_)) return refuse(io_error("cannot set options of the CAN socket", interface_));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index_;
  if (bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return refuse(io_error("cannot bind the CAN socket", interface_));
  kernel_drops_ = 0;
  return {};
}

/// The link is gone: closes it and plans the next try.
Error SocketCanLink::lost(int why) {
  close();
  retry_ = kFirstRetry;
  retry_at_ = clock_.now() + retry_;
  return {Errc::kLinkDown, "the CAN interface is down or gone", interface_, {}, std::strerror(why)};
}

void SocketCanLink::reconnect() {
  if (clock_.now() < retry_at_) return;
  if (connect()) {
    ++counters_.reopened;
    return;
  }
  retry_ = std::min(2 * retry_, kLastRetry);
  retry_at_ = clock_.now() + retry_;
}

Result<Poll> SocketCanLink::next(Packet& packet, Duration timeout) {
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

Result<Poll> SocketCanLink::receive(Packet& packet) {
  packet.bytes.resize(kFdBytes);
  iovec part{packet.bytes.data(), packet.bytes.size()};
  alignas(cmsghdr) std::array<std::byte, 128> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(fd_, &message, MSG_DONTWAIT);
  if (size < 0) {
    packet.bytes.clear();
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return Poll::kTimeout;
    return lost(errno);
  }
  packet.bytes.resize(static_cast<std::size_t>(size));
  read_stamp(message, packet);
  const bool own = (message.msg_flags & MSG_CONFIRM) != 0;
  counters_.own += own ? 1 : 0;
  packet.source = source_;
  packet.channel = static_cast<std::uint16_t>(own ? Direction::kSent : Direction::kReceived);
  packet.sequence = counters_.delivered++;
  packet.truncated = (message.msg_flags & MSG_TRUNC) != 0;
  return Poll::kPacket;
}

/// The kernel stamps on CLOCK_REALTIME; a stamp in the future or more than a second back on the monotonic line was made
/// before the wall clock was set.
void SocketCanLink::read_stamp(msghdr& message, Packet& packet) {
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

SendResult SocketCanLink::send(const CanFrame& frame) {
  if (!is_open()) return SendResult::kDown;
  canfd_frame bytes{};
  bytes.can_id = frame.id;
  bytes.len = frame.length;
  if (frame.fd) bytes.flags = frame.fd_flags;
  std::copy(frame.data.begin(), frame.data.end(), bytes.data);
  const std::size_t size = frame.fd ? sizeof(canfd_frame) : sizeof(can_frame);
  if (::send(fd_, &bytes, size, MSG_DONTWAIT) == static_cast<ssize_t>(size)) return SendResult::kSent;
  if (errno == ENOBUFS || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return SendResult::kQueueFull;
  return SendResult::kDown;  // next() finds out, closes and opens again
}

Result<void> SocketCanLink::restart() { return restart_can(interface_, index_); }

}  // namespace cairn::drive
