// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/socketcan_link.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "drivers/drive/can/socketcan_restart.hpp"

namespace cairn::drive {

static_assert(sizeof(can_frame) == kClassicBytes && sizeof(canfd_frame) == kFdBytes, "Packet bytes are the kernel's");
static_assert(CAN_EFF_FLAG == kExtended && CAN_RTR_FLAG == kRemote && CAN_ERR_FLAG == kErrorFrame);
static_assert(CAN_ERR_CRTL == kErrorController && CAN_ERR_ACK == kErrorNoAck && CAN_ERR_BUSOFF == kErrorBusOff &&
              CAN_ERR_RESTARTED == kErrorRestarted);

namespace {

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
  if (auto opened = made->connect_now(); !opened) return opened.error();
  return made;
}

Result<int> SocketCanLink::connect() {
  if (interface_.empty() || interface_.size() >= IFNAMSIZ)
    return Error{Errc::kInvalidConfig, "no name of an interface", interface_, {}, {}};
  const int fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (fd < 0) {
    Error error = io_error("cannot make a CAN socket");
    if (errno == EAFNOSUPPORT) error.detail += "; load the module: modprobe can-raw";
    return error;
  }
  const auto refuse = [&](Error error) {
    ::close(fd);
    return error;
  };
  ifreq request{};
  interface_.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(fd, SIOCGIFINDEX, &request) != 0)
    return refuse({Errc::kNotFound, "no such interface", interface_, {}, "ip -brief link shows which there are"});
  index_ = request.ifr_ifindex;
  if (ioctl(fd, SIOCGIFFLAGS, &request) != 0) return refuse(io_error("cannot ask for the interface"));
  if ((request.ifr_flags & IFF_UP) == 0)
    return refuse({Errc::kLinkDown, "the interface is down", interface_, {}, "ip link set " + interface_ + " up"});
  if (!set_options(fd)) return refuse(io_error("cannot set options of the CAN socket"));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index_;
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return refuse(io_error("cannot bind the CAN socket"));
  return fd;
}

Result<Poll> SocketCanLink::receive(Packet& packet) {
  int flags = 0;
  const auto received = receive_message(packet, flags);
  if (received && *received == Poll::kPacket)
    label(packet, (flags & MSG_CONFIRM) != 0 ? Direction::kSent : Direction::kReceived);
  return received;
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
