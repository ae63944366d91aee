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

/// Kind and size of a picture file.
struct PictureHeader {
  PictureKind kind{};
  std::uint32_t width = 0, height = 0;  ///< pixels
};

/// Reads kind and size of a PNG, JPEG or TIFF before a decoder sees the file. Sizes are bounded by kMaxSide and
/// kMaxPixels. A JPEG must be of the kind that cameras send (jpeg_header.hpp). A TIFF (6.0, any byte order) must not be
/// tiled, and no strip may be higher than the picture. Errors: kMalformed, kTruncated, kUnsupported, kLimit.
[[nodiscard]] Result<PictureHeader> parse_picture_header(std::span<const std::byte> file);

/// Turns a picture file into the frame that a device would have sent: 8-bit grey into GREY, 16-bit grey into `deep`
/// (kY16 or kZ16), colour of a TIFF or with a palette into BGR3. A JPEG becomes MJPG and a colour PNG becomes kPng:
/// neither is decoded here, where a task that reads packets may wait. Replaces the bytes of `packet` by header and
/// payload. Errors as above, and kUnsupported for other depths and channels.
[[nodiscard]] Result<void> picture_to_packet(std::span<const std::byte> file, FrameFormat deep,
                                             std::vector<std::byte>& packet);

/// Turns a frame into a file that gives the same pixels back: MJPG and kPng stay as they are, other formats become PNG,
/// YUV is converted to colour. `encoded` is replaced. Returns the extension of the file name.
[[nodiscard]] Result<std::string_view> frame_to_picture(const Frame& frame, std::vector<std::byte>& encoded);

/// Loads OpenCV's library for picture files, which takes 0.1 s once in a process. Whoever awaits pictures calls it, so
/// that the first one need not wait. Without the library nothing happens; the first picture then tells it.
void load_codecs();

}  // namespace cairn::camera
