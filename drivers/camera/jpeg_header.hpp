// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.hpp"

namespace cairn::camera {

struct JpegHeader {
  std::uint32_t width = 0, height = 0;  ///< pixels
  int components = 0;                   ///< 1 grey, 3 colour
};

/// Walks over the markers up to the first scan (ITU-T T.81 annex B) without decoding anything. Takes what MJPEG cameras
/// send and no more: baseline or extended Huffman, 8 bit, grey or three components, an end-of-image marker (a frame
/// without one lost its end; padding behind it is allowed), and at least the bits that so many blocks take. So the
/// memory and the time of decoding are bounded by the size that was negotiated. Errors: kMalformed, kTruncated,
/// kUnsupported.
[[nodiscard]] Result<JpegHeader> parse_jpeg_header(std::span<const std::byte> bytes);

}  // namespace cairn::camera
