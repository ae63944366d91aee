// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/picture.hpp"

#include <algorithm>
#include <array>

#include "drivers/clients/messages/camera.hpp"
#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr std::uint32_t kHeadBytes = 8 + 1 + 3 + 4 + 4, kMostInPart = Record::kMaxBody - kHeadBytes;

}  // namespace

std::uint32_t encode(const PicturePart& part, std::span<const std::byte> bytes, std::vector<std::byte>& out) {
  const auto total = static_cast<std::uint32_t>(std::min<std::size_t>(bytes.size(), PicturePart::kMaxBytes));
  const std::uint32_t first = std::min(part.first, total), count = std::min(total - first, kMostInPart);
  append_time(out, part.stamp);
  append_le(out, std::uint32_t{part.camera});
  append_le(out, total);
  append_le(out, first);
  const auto these = bytes.subspan(first, count);
  out.insert(out.end(), these.begin(), these.end());
  return count;
}

/// Every part but the last is full, so that no flood of small ones is taken for a picture.
Result<PicturePart> decode_picture(std::span<const std::byte> body) {
  FieldReader in(body);
  PicturePart part;
  part.stamp = in.time();
  part.camera = static_cast<std::uint8_t>(in.up_to<std::uint32_t>(CameraMessage::kMost - 1));
  part.total = in.up_to(PicturePart::kMaxBytes);
  part.first = in.up_to(part.total);
  const auto bytes = in.bytes(std::min(part.total - part.first, kMostInPart));
  part.bytes.assign(bytes.begin(), bytes.end());
  if (!in.complete()) return in.error("not a part of a picture");
  return part;
}

}  // namespace cairn::clients
