// SPDX-License-Identifier: Apache-2.0
// Any bytes as a depth frame: refused, or points that are finite, within the gate, and no more than there are pixels.
#include <cstdlib>

#include "drivers/depth/depth_camera.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  if (size < 3) return 0;
  depth::Config config;
  config.step_px = data[0] % 4 + 1;
  auto camera = depth::DepthCamera::create(config).value();
  Packet packet;
  if (data[0] < 0x80)
    camera::append_header(packet.bytes,
                          {camera::fourcc("Z16 "), data[1] + 1U, data[2] + 1U, 2 * (data[1] + 1U), false});
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  packet.bytes.insert(packet.bytes.end(), bytes + 3, bytes + size);
  const auto scan = camera.decode(packet);
  if (!scan) return 0;
  const PointCloud& cloud = (*scan)->cloud;
  if (cloud.size() * 2 > size) std::abort();
  for (const auto& p : cloud.xyz)
    if (!p.allFinite() || p.x() < 0.1999F || p.x() > 6.0001F) std::abort();
  return 0;
}
