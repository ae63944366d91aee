// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/jpeg_header.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace cairn::camera {
namespace {

constexpr std::uint8_t kStartOfFrame0 = 0xC0, kStartOfFrame1 = 0xC1, kHuffmanTables = 0xC4, kArithmeticTables = 0xCC,
                       kStartOfImage = 0xD8, kEndOfImage = 0xD9, kStartOfScan = 0xDA;

std::uint8_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
  return std::to_integer<std::uint8_t>(bytes[i]);
}
std::uint32_t big_endian16(std::span<const std::byte> bytes, std::size_t i) {
  return static_cast<std::uint32_t>(byte_at(bytes, i) << 8U | byte_at(bytes, i + 1));
}

bool is_start_of_frame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != kHuffmanTables && marker != 0xC8 && marker != kArithmeticTables;
}

/// `segment` starts behind the length.
Result<JpegHeader> parse_frame_segment(std::uint8_t marker, std::span<const std::byte> segment) {
  if (marker != kStartOfFrame0 && marker != kStartOfFrame1)
    return Error{Errc::kUnsupported, "JPEG is progressive, lossless or arithmetic; cameras send baseline"};
  if (segment.size() < 6) return Error{Errc::kMalformed, "JPEG frame header is too short"};
  JpegHeader header{big_endian16(segment, 3), big_endian16(segment, 1), byte_at(segment, 5)};
  if (byte_at(segment, 0) != 8) return Error{Errc::kUnsupported, "JPEG samples do not have 8 bits"};
  if (header.components != 1 && header.components != 3)
    return Error{Errc::kUnsupported, "JPEG has neither one nor three components"};
  if (segment.size() != 6 + 3 * static_cast<std::size_t>(header.components))
    return Error{Errc::kMalformed, "JPEG frame header has a wrong length"};
  if (header.width == 0 || header.height == 0) return Error{Errc::kMalformed, "JPEG has no width or no height"};
  return header;
}

bool has_end(std::span<const std::byte> bytes) {
  constexpr std::array kEnd{std::byte{0xFF}, std::byte{kEndOfImage}};
  return std::find_end(bytes.begin(), bytes.end(), kEnd.begin(), kEnd.end()) != bytes.end();
}

/// Every 8×8 block costs two bits at the least, and chroma may be spread over 4×4 of them.
bool too_short(const JpegHeader& h, std::size_t bytes) {
  return std::uint64_t{bytes} * 1024 < std::uint64_t{h.width} * h.height;
}

}  // namespace

Result<JpegHeader> parse_jpeg_header(std::span<const std::byte> bytes) {
  constexpr Errc kBad = Errc::kMalformed;
  if (bytes.size() < 2 || big_endian16(bytes, 0) != (0xFF00U | kStartOfImage))
    return Error{kBad, "not a JPEG", {}, 0, {}};
  std::optional<JpegHeader> header;
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    if (byte_at(bytes, at) != 0xFF) return Error{kBad, "no JPEG marker where one has to be", {}, at, {}};
    const std::uint8_t marker = byte_at(bytes, at + 1);
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const std::uint32_t length = big_endian16(bytes, at + 2);
    if (marker < kStartOfFrame0 || (marker >= 0xD0 && marker <= kEndOfImage) || length < 2)
      return Error{kBad, "JPEG marker is out of place", {}, at, {}};
    if (bytes.size() - at - 2 < length) break;
    if (is_start_of_frame(marker)) {
      if (header) return Error{kBad, "JPEG has two frame headers", {}, at, {}};
      auto parsed = parse_frame_segment(marker, bytes.subspan(at + 4, length - 2));
      if (!parsed) return parsed;
      header = *parsed;
    }
    at += 2 + length;
    if (marker != kStartOfScan) continue;
    if (!header) return Error{kBad, "JPEG scan comes before the frame header", {}, at, {}};
    if (too_short(*header, bytes.size()) || !has_end(bytes.subspan(at)))
      return Error{Errc::kTruncated, "JPEG is cut off", {}, bytes.size(), {}};
    return *header;
  }
  return Error{Errc::kTruncated, "JPEG ends before its picture", {}, bytes.size(), {}};
}

}  // namespace cairn::camera
