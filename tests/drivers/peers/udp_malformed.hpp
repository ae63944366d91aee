// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace cairn::peer_link {

/// An RTPS header and a DATA submessage that is none: Cyclone writes a line for each.
inline std::string malformed_rtps(unsigned number) {
  std::string bytes("RTPS\x02\x01\x01\x10", 8);
  bytes.append(12, static_cast<char>(number));
  bytes.append("\x15\x05\x08\x00", 4);
  bytes.append(8, static_cast<char>(number >> 8U));
  return bytes;
}

/// To every process that may listen in the domain.
inline void send_malformed(unsigned domain, unsigned count) {
  constexpr unsigned kBase = 7400, kOfDomain = 250, kUnicastMeta = 10, kProcesses = 4;
  const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (unsigned i = 0; i < count; ++i) {
    const std::string bytes = malformed_rtps(i);
    to.sin_port = htons(static_cast<std::uint16_t>(kBase + kOfDomain * domain + kUnicastMeta + 2 * (i % kProcesses)));
    (void)::sendto(sender, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  ::close(sender);
}

}  // namespace cairn::peer_link
