// SPDX-License-Identifier: Apache-2.0
// Any captured frame of any link type: the datagram found lies inside the frame, or there is an error with an offset.
#include <array>
#include <cstdlib>

#include "drivers/velodyne/transport/frame.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn::velodyne;
  constexpr std::array kLinks{kLinkNull, kLinkEthernet, kLinkRawDlt, kLinkRaw, kLinkSll, kLinkIpv4, kLinkSll2, 105};
  if (size == 0) return 0;
  const std::span frame(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
  const auto datagram = udp_in_frame(kLinks[data[0] % kLinks.size()], frame);
  if (!datagram) {
    if (!datagram.error().offset || *datagram.error().offset > frame.size()) std::abort();
    return 0;
  }
  const auto payload = datagram->payload;
  const bool inside = payload.data() >= frame.data() && payload.data() + payload.size() <= frame.data() + frame.size();
  if (!inside || payload.size() > 65'527) std::abort();
  return 0;
}
