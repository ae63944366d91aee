// SPDX-License-Identifier: Apache-2.0
// Any bytes as the start of a .npy file: refused, or pictures of a size that a camera may have.
#include <cstdlib>

#include "drivers/camera/npy.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn::camera;
  const std::span start(reinterpret_cast<const std::byte*>(data), size);
  const auto array = parse_npy_array(start);
  if (array && (array->data_offset > size || array->type.empty() || array->shape.empty())) std::abort();
  const auto header = parse_npy_header(start);
  if (!header) return 0;
  const bool sound = header->data_offset <= size && header->width > 0 && header->height > 0 &&
                     header->width <= kMaxSide && header->height <= kMaxSide &&
                     header->frame_bytes() <= std::uint64_t{2} * kMaxPixels &&
                     (header->pixel_bytes == 1 || header->pixel_bytes == 2);
  if (!sound) std::abort();
  return 0;
}
