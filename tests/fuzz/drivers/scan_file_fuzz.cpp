// SPDX-License-Identifier: Apache-2.0
// Any bytes as a sweep: refused, or a scan whose points are finite and within its time, every record accounted for.
#include <vector>

#include "drivers/recording/formats/scan_file.hpp"
#include "tests/fuzz/require.hpp"

using namespace cairn;
using namespace cairn::recording;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  Packet packet;
  packet.channel = data[0] % 3;
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  packet.bytes.assign(bytes + 1, bytes + size);
  ScanFileDecoder decoder(false);
  const auto scan = decoder.decode(packet);
  require(scan.has_value() || decoder.rejected_packets() == 1);
  if (!scan) return 0;
  const std::size_t record = packet.channel == 0 ? 16 : 20;
  require((*scan)->cloud.size() + decoder.rejected_points() == packet.bytes.size() / record);
  for (std::size_t i = 0; i < (*scan)->cloud.size(); ++i) {
    require((*scan)->cloud.xyz[i].allFinite() && (*scan)->cloud.xyz[i].norm() < 2e4F);
    require((*scan)->valid.start + Duration((*scan)->cloud.offset_ns[i]) <= (*scan)->valid.end);
  }
  return 0;
}
