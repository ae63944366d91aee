// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace cairn::camera {

/// V4L2's code: four characters, the first in the lowest byte (kernel documentation, "Image Formats").
[[nodiscard]] constexpr std::uint32_t fourcc(const char (&text)[5]) {
  std::uint32_t code = 0;
  for (unsigned i = 0; i < 4; ++i) code |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])) << (8 * i);
  return code;
}

/// The pixel formats of cameras that Cairn decodes.
enum class FrameFormat : std::uint32_t {
  kYuyv = fourcc("YUYV"),  ///< Y0 U Y1 V, BT.601 limited range
  kUyvy = fourcc("UYVY"),  ///< U Y0 V Y1
  kNv12 = fourcc("NV12"),  ///< a Y plane, then a plane of U V pairs at half the width and height
  kGrey = fourcc("GREY"),  ///< 8 bit
  kBgr = fourcc("BGR3"),   ///< 8 bit blue, green, red
  kMjpg = fourcc("MJPG"),  ///< one JPEG per frame
  kPng = fourcc("PNG "),   ///< one PNG per frame, 8 bit colour; of replays, no device sends it
  kY16 = fourcc("Y16 "),   ///< 16 bit little-endian
  kZ16 = fourcc("Z16 "),   ///< 16 bit depth, little-endian
};

/// One line of the table of formats.
struct FormatInfo {
  FrameFormat format;
  const char* name;      ///< as in a robot profile and in V4L2's tools
  unsigned pixel_bytes;  ///< in a row of the first plane; 0: compressed
  unsigned even;         ///< the width must be a multiple of it; for NV12 also the height
  bool half_plane;       ///< a second plane of half the height follows
};
/// The table of formats.
[[nodiscard]] std::span<const FormatInfo> formats();
/// Null for a format that is not in the table.
[[nodiscard]] const FormatInfo* find_format(std::uint32_t code);
/// The same by FormatInfo::name.
[[nodiscard]] const FormatInfo* find_format(std::string_view name);
/// A code as text for messages, such as "YUYV". Characters that cannot be printed become '?'.
[[nodiscard]] std::string format_name(std::uint32_t code);

/// What was negotiated with the device about each frame.
struct FrameHeader {
  std::uint32_t format = 0;          ///< FrameFormat, or any other code
  std::uint32_t width = 0;           ///< pixels
  std::uint32_t height = 0;          ///< pixels
  std::uint32_t bytes_per_line = 0;  ///< from one row of the first plane to the next; 0 for compressed formats
  bool start_of_exposure = false;    ///< Packet::arrival is the start of the exposure, otherwise the end of the frame
};

/// A frame whose bytes are all checked. Later code may index them without further checks.
struct Frame {
  FrameHeader header;
  const FormatInfo* info = nullptr;    ///< never null
  std::span<const std::byte> payload;  ///< V4L2's bytesused of them, in the memory of the packet or device
};

inline constexpr std::uint32_t kMaxSide = 8192;         ///< pixels
inline constexpr std::uint32_t kMaxPixels = 1U << 24U;  ///< of one frame; the largest stereo camera has 5.5 million

/// Checks format, sizes and strides, and that `payload` holds all rows. Errors: kUnsupported, kMalformed, kLimit,
/// kTruncated.
[[nodiscard]] Result<Frame> check_frame(const FrameHeader& header, std::span<const std::byte> payload);

/// A frame in a Packet: the header in kFrameHeaderBytes bytes (five little-endian u32: format, width, height, bytes per
/// line, flags with bit 0 = start of exposure), then the payload as the device gave it.
inline constexpr std::size_t kFrameHeaderBytes = 20;
void append_header(std::vector<std::byte>& out, const FrameHeader& header);
/// Reads the header of a packet. Errors: kTruncated, kMalformed.
[[nodiscard]] Result<FrameHeader> parse_header(std::span<const std::byte> packet);
/// parse_header() and check_frame().
[[nodiscard]] Result<Frame> parse_frame(std::span<const std::byte> packet);

}  // namespace cairn::camera
