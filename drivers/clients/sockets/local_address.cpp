// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/sockets/local_address.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace cairn::clients {

std::optional<sockaddr_un> local_address(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.native().size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  return address;
}

int connect_local(const sockaddr_un& address) {
  const int fd = ::socket(AF_UNIX, kLocalType, 0);
  if (fd < 0) return -1;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  const int why = errno;
  ::close(fd);
  errno = why;
  return -1;
}

Error local_error(std::string_view cause, const std::filesystem::path& path) {
  return {Errc::kIo, cause, path.string(), {}, std::generic_category().message(errno)};
}

}  // namespace cairn::clients
