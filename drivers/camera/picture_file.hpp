// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/camera/frame.hpp"

namespace cairn::camera {

enum class PictureKind : std::uint8_t { kPng, kJpeg, kTiff };

struct PictureHeader {
  PictureKind kind{};
  std::uint32_t width = 0, height = 0;  ///< pixels
};

/// Kind and size of a PNG, JPEG or TIFF, read before any decoder sees it: sizes are bounded by kMaxSide and kMaxPixels,
/// JPEGs have to be such as cameras send (jpeg_header.hpp), TIFFs (6.0, little- or big-endian) must not be tiled and no
/// strip may be higher than the picture. Errors: kMalformed, kTruncated, kUnsupported, kLimit.
[[nodiscard]] Result<PictureHeader> parse_picture_header(std::span<const std::byte> file);

/// A picture file as the frame that a device would have sent: colour as BGR3, 8-bit grey as GREY, 16-bit grey as `deep`
/// (kY16 or kZ16), a JPEG as MJPG, undecoded. Replaces `packet`'s bytes by header and payload. Errors as above, and
/// kUnsupported for other depths and channels.
[[nodiscard]] Result<void> picture_to_packet(std::span<const std::byte> file, FrameFormat deep,
                                             std::vector<std::byte>& packet);

/// A frame as a file that gives the same pixels back: MJPG as it is (".jpg"), all else as PNG, YUV converted to colour.
/// `encoded` is replaced; returns the file name's extension.
[[nodiscard]] Result<std::string_view> frame_to_picture(const Frame& frame, std::vector<std::byte>& encoded);

}  // namespace cairn::camera
