// SPDX-License-Identifier: Apache-2.0
// Any file as a capture: packets, then an end; at most one error, and never a packet after it.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "drivers/velodyne/transport/pcap_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  if (size == 0) return 0;
  std::vector<unsigned char> copy(data, data + size);
  std::FILE* file = fmemopen(copy.data(), copy.size(), "rb");
  if (file == nullptr) return 0;
  const auto source = velodyne::PcapSource::from_stream(file, "fuzz", {});
  if (!source) return 0;
  Packet packet;
  bool failed = false;
  for (;;) {
    const auto poll = (*source)->next(packet, {});
    if (!poll) {
      if (failed || to_string(poll.error()).empty()) std::abort();
      failed = true;
      continue;
    }
    if (*poll == Poll::kEnd) return 0;
    if (failed || packet.bytes.size() > size) std::abort();
  }
}
