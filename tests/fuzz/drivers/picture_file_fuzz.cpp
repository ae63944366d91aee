// SPDX-License-Identifier: Apache-2.0
// Any bytes as a picture file: refused, or a frame that holds all its pixels. The size is bounded here to what a fuzzer
// can decode often; the driver's own bound is checked before.
#include <cstdlib>
#include <vector>

#include "drivers/camera/picture_file.hpp"

namespace {

void require(bool property) {
  if (!property) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn::camera;
  const std::span file(reinterpret_cast<const std::byte*>(data), size);
  const auto header = parse_picture_header(file);
  if (!header) return 0;
  require(header->width <= kMaxSide && header->height <= kMaxSide && header->width * header->height <= kMaxPixels);
  if (header->width * header->height > 65536) return 0;
  std::vector<std::byte> packet;
  if (!picture_to_packet(file, FrameFormat::kY16, packet)) return 0;
  const auto frame = parse_frame(packet);
  require(frame.has_value());
  require(frame->header.width == header->width && frame->header.height == header->height);
  return 0;
}
