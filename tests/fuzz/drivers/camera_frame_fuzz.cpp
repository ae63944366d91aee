// SPDX-License-Identifier: Apache-2.0
// Any bytes as a frame of any format: refused, or a picture of exactly the size that the header says. The first byte
// chooses the format, two more a small size; half of the inputs are raw packets with a header of their own.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "drivers/camera/convert.hpp"
#include "hal/bytes.hpp"

namespace {

using namespace cairn;
using namespace cairn::camera;

void require(bool property) {
  if (!property) std::abort();
}

void as_packet(std::span<const std::byte> bytes) {
  static Camera decoder = Camera::create({}).value();
  static Packet packet;
  packet.bytes.assign(bytes.begin(), bytes.end());
  ++packet.sequence;
  const auto image = decoder.decode(packet);
  if (!image) return;
  const FrameHeader header = parse_header(bytes).value();
  const Image& picture = **image;
  require(picture.width == static_cast<int>(header.width) && picture.height == static_cast<int>(header.height));
  require(picture.bytes.size() == picture.stride * header.height);
  if (const auto eyes = split_side_by_side(picture.view()))
    require(eyes->right.row(eyes->right.height - 1).size() * 2 == picture.stride);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  if (size < 4) return 0;
  if (data[0] >= 0x80) return as_packet(bytes.subspan(1)), 0;
  const FormatInfo& info = formats()[data[0] % formats().size()];
  FrameHeader header{static_cast<std::uint32_t>(info.format), data[1] + 1U, data[2] + 1U, 0, false};
  header.bytes_per_line = info.pixel_bytes == 0 ? 0 : header.width * info.pixel_bytes + data[3] % 16;
  std::vector<std::byte> packet;
  append_header(packet, header);
  packet.insert(packet.end(), bytes.begin() + 4, bytes.end());
  as_packet(packet);
  return 0;
}
