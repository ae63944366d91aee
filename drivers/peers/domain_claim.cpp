// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/domain_claim.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>
#include <system_error>

namespace cairn::peer_link {
namespace {

// Clear of the default (see DdsConfig), and the ports of all are below those that Linux hands out, which begin at
// 32768.
constexpr unsigned kFirst = 50, kEnd = 100;

/// Binds a name without a file: it is held until the socket is closed.
bool take_name(int socket, unsigned domain) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "cairn-dds-domain-" + std::to_string(domain);
  std::memcpy(address.sun_path + 1, name.data(), name.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return ::bind(socket, reinterpret_cast<const sockaddr*>(&address), length) == 0;
}

}  // namespace

Result<DomainClaim> DomainClaim::make() {
  DomainClaim claim(kFirst, ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  while (claim.domain_ < kEnd && !take_name(claim.socket_, claim.domain_)) {
    if (errno != EADDRINUSE)
      return Error{Errc::kIo, "cannot claim a DDS domain", {}, {}, std::generic_category().message(errno)};
    ++claim.domain_;
  }
  if (claim.domain_ == kEnd) return Error{Errc::kLimit, "too many teams on this machine", {}, {}, {}};
  return claim;
}

DomainClaim::~DomainClaim() {
  if (socket_ >= 0) ::close(socket_);
}

}  // namespace cairn::peer_link
