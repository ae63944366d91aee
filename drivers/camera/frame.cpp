// SPDX-License-Identifier: Apache-2.0
#include "drivers/camera/frame.hpp"

#include <algorithm>
#include <array>

#include "hal/bytes.hpp"

namespace cairn::camera {
namespace {

constexpr std::array kFormats{
    FormatInfo{FrameFormat::kYuyv, "YUYV", 2, 2, false}, FormatInfo{FrameFormat::kUyvy, "UYVY", 2, 2, false},
    FormatInfo{FrameFormat::kNv12, "NV12", 1, 2, true},  FormatInfo{FrameFormat::kGrey, "GREY", 1, 1, false},
    FormatInfo{FrameFormat::kBgr, "BGR3", 3, 1, false},  FormatInfo{FrameFormat::kMjpg, "MJPG", 0, 1, false},
    FormatInfo{FrameFormat::kPng, "PNG", 0, 1, false},   FormatInfo{FrameFormat::kY16, "Y16", 2, 1, false},
    FormatInfo{FrameFormat::kZ16, "Z16", 2, 1, false}};

constexpr std::uint32_t kStartOfExposure = 1;

/// Bytes from the first pixel to the last; the last row needs no padding.
std::uint64_t needed_bytes(const FrameHeader& h, const FormatInfo& info) {
  if (info.pixel_bytes == 0) return 1;
  const std::uint64_t rows = info.half_plane ? h.height + h.height / 2 : h.height;
  return (rows - 1) * h.bytes_per_line + std::uint64_t{h.width} * info.pixel_bytes;
}

bool odd(const FrameHeader& h, const FormatInfo& info) {
  return h.width % info.even != 0 || (info.half_plane && h.height % info.even != 0);
}

}  // namespace

std::span<const FormatInfo> formats() { return kFormats; }

const FormatInfo* find_format(std::uint32_t code) {
  const auto* found = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const FormatInfo& f) { return static_cast<std::uint32_t>(f.format) == code; });
  return found == kFormats.end() ? nullptr : found;
}

const FormatInfo* find_format(std::string_view name) {
  const auto* found =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const FormatInfo& f) { return f.name == name; });
  return found == kFormats.end() ? nullptr : found;
}

std::string format_name(std::uint32_t code) {
  std::string name;
  for (unsigned i = 0; i < 4; ++i) {
    const auto c = static_cast<unsigned char>(code >> (8 * i));
    name += c >= ' ' && c < 127 ? static_cast<char>(c) : '?';
  }
  return name;
}

Result<Frame> check_frame(const FrameHeader& h, std::span<const std::byte> payload) {
  const FormatInfo* info = find_format(h.format);
  if (info == nullptr) return Error{Errc::kUnsupported, "pixel format is not one that we decode", {}, 0, {}};
  if (h.width == 0 || h.height == 0) return Error{Errc::kMalformed, "a frame has no width or no height", {}, 4, {}};
  if (h.width > kMaxSide || h.height > kMaxSide || std::uint64_t{h.width} * h.height > kMaxPixels)
    return Error{Errc::kLimit, "a frame has more pixels than any camera", {}, 4, {}};
  if (odd(h, *info))
    return Error{Errc::kMalformed, "width or height is odd in a format that has pixel pairs", {}, 4, {}};
  if (h.bytes_per_line < std::uint64_t{h.width} * info->pixel_bytes)
    return Error{Errc::kMalformed, "bytes per line are fewer than a row of pixels needs", {}, 12, {}};
  if (payload.size() < needed_bytes(h, *info))
    return Error{Errc::kTruncated, "a frame has fewer bytes than its size asks for", {}, {}, {}};
  return Frame{h, info, payload};
}

void append_header(std::vector<std::byte>& out, const FrameHeader& h) {
  append_le(out, h.format);
  append_le(out, h.width);
  append_le(out, h.height);
  append_le(out, h.bytes_per_line);
  append_le(out, h.start_of_exposure ? kStartOfExposure : std::uint32_t{0});
}

Result<FrameHeader> parse_header(std::span<const std::byte> packet) {
  if (packet.size() < kFrameHeaderBytes) return Error{Errc::kTruncated, "packet ends inside the frame's header"};
  const auto word = [&](std::size_t i) { return load_le<std::uint32_t>(packet, 4 * i); };
  if (word(4) > kStartOfExposure) return Error{Errc::kMalformed, "unknown flags in the frame's header", {}, 16, {}};
  return FrameHeader{word(0), word(1), word(2), word(3), word(4) == kStartOfExposure};
}

Result<Frame> parse_frame(std::span<const std::byte> packet) {
  const auto header = parse_header(packet);
  if (!header) return header.error();
  return check_frame(*header, packet.subspan(kFrameHeaderBytes));
}

}  // namespace cairn::camera
