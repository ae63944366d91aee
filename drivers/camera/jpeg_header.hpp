// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.hpp"

namespace cairn::camera {

/// The size of a JPEG, from its frame header.
struct JpegHeader {
  std::uint32_t width = 0, height = 0;  ///< pixels
  int components = 0;                   ///< 1 grey, 3 colour
};

/// Reads the markers up to the first scan (ITU-T T.81 annex B) without decoding anything. Accepts only what MJPEG
/// cameras send: baseline or extended Huffman, 8 bit, grey or three components. An end-of-image marker must follow
/// (padding behind it is allowed), and at least the bits that so many blocks take. So the size bounds the memory and
/// time of decoding. Errors: kMalformed, kTruncated, kUnsupported.
[[nodiscard]] Result<JpegHeader> parse_jpeg_header(std::span<const std::byte> bytes);

}  // namespace cairn::camera
