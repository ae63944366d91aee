// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/socketcan_restart.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace cairn::drive {
namespace {

/// A netlink message under construction.
struct Message {
  nlmsghdr header{};
  ifinfomsg link{};
  std::array<std::byte, 128> attributes{};
  std::size_t size = 0;

  rtattr* add(unsigned short type, const void* data, std::size_t bytes) {
    auto* attribute = reinterpret_cast<rtattr*>(attributes.data() + size);
    attribute->rta_type = type;
    attribute->rta_len = static_cast<unsigned short>(RTA_LENGTH(bytes));
    if (bytes > 0) std::memcpy(RTA_DATA(attribute), data, bytes);
    size += RTA_SPACE(bytes);
    return attribute;
  }
  /// Makes `attribute` contain all that was added after it.
  void close(rtattr* attribute) const {
    attribute->rta_len =
        static_cast<unsigned short>(attributes.data() + size - reinterpret_cast<std::byte*>(attribute));
  }
};
static_assert(offsetof(Message, attributes) == NLMSG_LENGTH(sizeof(ifinfomsg)), "attributes follow the header");

Message restart_message(int index) {
  Message m;
  m.header.nlmsg_type = RTM_NEWLINK;
  m.header.nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK;
  m.link.ifi_index = index;
  constexpr std::uint32_t kRestart = 1;
  rtattr* info = m.add(IFLA_LINKINFO, nullptr, 0);
  m.add(IFLA_INFO_KIND, "can", 3);
  rtattr* data = m.add(IFLA_INFO_DATA, nullptr, 0);
  m.add(IFLA_CAN_RESTART, &kRestart, sizeof kRestart);
  m.close(data);
  m.close(info);
  m.header.nlmsg_len = static_cast<std::uint32_t>(NLMSG_LENGTH(sizeof(ifinfomsg)) + m.size);
  return m;
}

/// errno of the answer; 0: done.
int transact(const Message& message) {
  const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (fd < 0) return errno;
  struct {
    nlmsghdr header{};
    nlmsgerr error{};
    std::array<std::byte, 256> rest{};
  } answer;
  int why = 0;
  if (send(fd, &message, message.header.nlmsg_len, 0) < 0 || recv(fd, &answer, sizeof answer, 0) < 0)
    why = errno;
  else if (answer.header.nlmsg_type == NLMSG_ERROR)
    why = -answer.error.error;
  close(fd);
  return why;
}

}  // namespace

Result<void> restart_can(const std::string& interface, int index) {
  const int why = transact(restart_message(index));
  if (why == 0) return {};
  std::string detail = std::strerror(why);
  if (why == EPERM)
    detail += "; give the program CAP_NET_ADMIN, or let the kernel do it: ip link set " + interface +
              " type can restart-ms 100";
  return Error{Errc::kIo, "cannot restart the CAN controller", interface, {}, std::move(detail)};
}

}  // namespace cairn::drive
