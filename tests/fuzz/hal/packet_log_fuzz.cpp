// SPDX-License-Identifier: Apache-2.0
// Any file as a packet log: packets, then an end; at most one error, and never a packet after it. What was read is
// written as it was.
#include <sstream>
#include <string>

#include "drivers/peers/peer_packet.hpp"
#include "hal/files/packet_log.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto source =
      PacketLogSource::from_stream(std::make_unique<std::istringstream>(bytes), "fuzz", peer_link::kPeersLog, {});
  if (!source) return 0;
  std::vector<std::byte> again;
  append_log_header(peer_link::kPeersLog, again);
  Packet packet;
  bool failed = false;
  for (;;) {
    const auto poll = (*source)->next(packet, {});
    if (poll && *poll == Poll::kEnd) break;
    require(!failed);
    failed = !poll;
    if (failed) continue;
    require(packet.bytes.size() <= peer_link::kMaxPacket);
    require(append_log_record(peer_link::kPeersLog, packet, again).has_value());
    (void)peer_link::decode_beginning(packet.payload());
  }
  require(again.size() <= size &&
          bytes.compare(0, again.size(), reinterpret_cast<const char*>(again.data()), again.size()) == 0);
  return 0;
}
