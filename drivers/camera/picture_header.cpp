// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "drivers/camera/jpeg_header.hpp"
#include "drivers/camera/picture_file.hpp"

namespace cairn::camera {
namespace {

using Bytes = std::span<const std::byte>;

/// Reads numbers of either byte order; what lies beyond the end is none.
class OrderedReader {
 public:
  OrderedReader(Bytes bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}
  [[nodiscard]] std::optional<std::uint32_t> number(std::uint64_t at, unsigned size) const {
    if (at > bytes_.size() || bytes_.size() - at < size) return std::nullopt;
    std::uint32_t value = 0;
    for (unsigned i = 0; i < size; ++i) {
      const unsigned shift = 8 * (big_endian_ ? size - 1 - i : i);
      value |= std::to_integer<std::uint32_t>(bytes_[static_cast<std::size_t>(at) + i]) << shift;
    }
    return value;
  }

 private:
  Bytes bytes_;
  bool big_endian_;
};

bool starts_with(Bytes bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::equal(text.begin(), text.end(), bytes.begin(), [](char c, std::byte b) {
           return static_cast<unsigned char>(c) == std::to_integer<unsigned char>(b);
         });
}

/// PNG specification, "IHDR": always the first chunk.
Result<PictureHeader> parse_png(Bytes file) {
  const OrderedReader in(file, true);
  const auto width = in.number(16, 4), height = in.number(20, 4);
  if (!height) return Error{Errc::kTruncated, "PNG ends inside its header"};
  if (!starts_with(file.subspan(12), "IHDR"))
    return Error{Errc::kMalformed, "PNG does not begin with its header", {}, 12, {}};
  return PictureHeader{PictureKind::kPng, *width, *height};
}

// TIFF 6.0, sections 2 and 8; tags as decimal numbers there too.
constexpr std::uint32_t kWidth = 256, kHeight = 257, kRowsPerStrip = 278, kTileWidth = 322, kTileOffsets = 325;
constexpr std::uint32_t kMaxTags = 256;

struct TiffFacts {
  std::uint32_t width = 0, height = 0;
  std::uint32_t rows_per_strip = 0;  // 0: not said, or all
};

Result<void> take_tag(const OrderedReader& in, std::uint64_t at, std::uint32_t tag, TiffFacts& facts) {
  constexpr std::uint32_t kShort = 3, kLong = 4;
  if (tag >= kTileWidth && tag <= kTileOffsets) return Error{Errc::kUnsupported, "TIFF is tiled", {}, at, {}};
  if (tag != kWidth && tag != kHeight && tag != kRowsPerStrip) return {};
  const auto type = in.number(at + 2, 2), count = in.number(at + 4, 4);
  if (count != 1U || (type != kShort && type != kLong))
    return Error{Errc::kMalformed, "TIFF gives a size that is no number", {}, at, {}};
  const auto value = in.number(at + 8, type == kShort ? 2 : 4).value_or(0);
  if (tag == kWidth) facts.width = value;
  if (tag == kHeight) facts.height = value;
  if (tag == kRowsPerStrip && value != 0xFFFFFFFF) facts.rows_per_strip = value;
  return {};
}

Result<PictureHeader> parse_tiff(Bytes file) {
  const OrderedReader in(file, starts_with(file, "MM"));
  const std::uint64_t directory = in.number(4, 4).value_or(0);
  const auto tags = in.number(directory, 2);
  if (!tags || directory < 8) return Error{Errc::kTruncated, "TIFF has no directory", {}, directory, {}};
  if (*tags > kMaxTags) return Error{Errc::kLimit, "TIFF has too many tags", {}, directory, {}};
  TiffFacts facts;
  std::uint32_t last = 0;
  for (std::uint32_t i = 0; i < *tags; ++i) {
    const std::uint64_t at = directory + 2 + std::uint64_t{12} * i;
    const auto tag = in.number(at, 2);
    if (!tag || !in.number(at + 11, 1)) return Error{Errc::kTruncated, "TIFF ends inside its directory", {}, at, {}};
    if (i > 0 && *tag <= last) return Error{Errc::kMalformed, "TIFF tags are not in order", {}, at, {}};
    last = *tag;
    if (auto taken = take_tag(in, at, *tag, facts); !taken) return taken.error();
  }
  if (facts.rows_per_strip > facts.height) return Error{Errc::kMalformed, "TIFF strips are higher than the picture"};
  return PictureHeader{PictureKind::kTiff, facts.width, facts.height};
}

Result<PictureHeader> parse_any(Bytes file) {
  using namespace std::string_view_literals;
  if (starts_with(file, "\x89PNG\r\n\x1A\n")) return parse_png(file);
  if (starts_with(file, "II\x2A\0"sv) || starts_with(file, "MM\0\x2A"sv)) return parse_tiff(file);
  const auto jpeg = parse_jpeg_header(file);
  if (!jpeg && starts_with(file, "\xFF\xD8")) return jpeg.error();
  if (!jpeg) return Error{Errc::kUnsupported, "neither PNG nor JPEG nor TIFF", {}, 0, {}};
  return PictureHeader{PictureKind::kJpeg, jpeg->width, jpeg->height};
}

}  // namespace

Result<PictureHeader> parse_picture_header(Bytes file) {
  auto header = parse_any(file);
  if (!header) return header;
  if (header->width == 0 || header->height == 0) return Error{Errc::kMalformed, "a picture has no width or no height"};
  if (header->width > kMaxSide || header->height > kMaxSide ||
      std::uint64_t{header->width} * header->height > kMaxPixels)
    return Error{Errc::kLimit, "a picture has more pixels than any camera"};
  return header;
}

}  // namespace cairn::camera
