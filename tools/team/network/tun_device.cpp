// SPDX-License-Identifier: Apache-2.0
#include "tools/team/network/tun_device.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace cairn::team_run {
namespace {

Error refused(const char* step) {
  return {Errc::kIo, "cannot make a network", step, {}, std::generic_category().message(errno)};
}

ifreq request_about(const char* device) {
  ifreq request{};
  std::strncpy(request.ifr_name, device, sizeof request.ifr_name - 1);
  return request;
}

bool bring_up(int socket, const char* device) {
  ifreq request = request_about(device);
  if (::ioctl(socket, SIOCGIFFLAGS, &request) != 0) return false;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
  return ::ioctl(socket, SIOCSIFFLAGS, &request) == 0;
}

bool set_address(int socket, const char* device, const std::string& address) {
  const auto set = [&](unsigned long what, const char* dots) {
    ifreq request = request_about(device);
    sockaddr_in internet{};
    internet.sin_family = AF_INET;
    if (::inet_pton(AF_INET, dots, &internet.sin_addr) != 1) return false;
    std::memcpy(&request.ifr_addr, &internet, sizeof internet);
    return ::ioctl(socket, what, &request) == 0;
  };
  return set(SIOCSIFADDR, address.c_str()) && set(SIOCSIFNETMASK, "255.255.255.0");
}

/// A file such as /proc/self/uid_map takes one write.
bool write_once(const char* path, const std::string& text) {
  const File file(::open(path, O_WRONLY | O_CLOEXEC));
  return file.get() >= 0 && ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

}  // namespace

File& File::operator=(File&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

File::~File() {
  if (fd_ >= 0) ::close(fd_);
}

Result<File> current_network() {
  File file(::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) return refused("/proc/thread-self/ns/net");
  return file;
}

Result<TunNamespace> make_tun_namespace(const std::string& address) {
  if (::unshare(CLONE_NEWNET) != 0) return refused(kNoNamespace);
  const File socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  // First of all: who cannot go back to where it came from at least has a loopback.
  if (!bring_up(socket.get(), "lo")) return refused("a loopback");
  auto network = current_network();
  if (!network) return network.error();
  File packets(::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (packets.get() < 0) return refused("/dev/net/tun");
  ifreq request = request_about(kTunName);
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (::ioctl(packets.get(), TUNSETIFF, &request) != 0) return refused("a TUN device");
  if (!set_address(socket.get(), kTunName, address)) return refused("its address");
  if (!bring_up(socket.get(), kTunName)) return refused("its device");
  return TunNamespace{*std::move(network), std::move(packets)};
}

Result<void> enter_user_namespace() {
  const auto user = ::getuid();
  const auto group = ::getgid();
  if (::unshare(CLONE_NEWUSER) != 0) return refused("a user namespace");
  const auto itself = [](auto id) { return std::to_string(id) + " " + std::to_string(id) + " 1\n"; };
  if (!write_once("/proc/self/setgroups", "deny") || !write_once("/proc/self/uid_map", itself(user)) ||
      !write_once("/proc/self/gid_map", itself(group)))
    return refused("a user namespace's ids");
  return {};
}

}  // namespace cairn::team_run
