// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "hal/packet.hpp"
#include "hal/time.hpp"

namespace cairn {

/// How the bytes of one pixel are to be read; multi-byte values are little-endian.
enum class PixelFormat : std::uint8_t {
  kMono8,    ///< 1 byte, grey
  kBgr8,     ///< 3 bytes: blue, green, red (OpenCV's order)
  kMono16,   ///< u16 counts without a unit
  kDepth16,  ///< u16 depth along the optical axis, in the sensor's depth unit; 0: no measurement (REP 118)
  kCelsius,  ///< float32 degrees Celsius
};

[[nodiscard]] constexpr std::size_t bytes_per_pixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::kMono8:
      return 1;
    case PixelFormat::kBgr8:
      return 3;
    case PixelFormat::kMono16:
    case PixelFormat::kDepth16:
      return 2;
    case PixelFormat::kCelsius:
      break;
  }
  return 4;
}

/// A rectangle of pixels that someone else owns: a whole image or a part of one. Row 0 is the top, column 0 the left.
struct ImageView {
  PixelFormat format = PixelFormat::kMono8;
  int width = 0, height = 0;         ///< pixels
  std::size_t stride = 0;            ///< bytes from one row to the next, at least width · bytes_per_pixel
  std::span<const std::byte> bytes;  ///< from the first pixel to the last; the end of the last row's stride may lack

  [[nodiscard]] bool empty() const { return width == 0 || height == 0; }
  /// The width · bytes_per_pixel bytes of row 0 <= y < height.
  [[nodiscard]] std::span<const std::byte> row(int y) const {
    return bytes.subspan(static_cast<std::size_t>(y) * stride,
                         static_cast<std::size_t>(width) * bytes_per_pixel(format));
  }
  /// Channel 0 <= c of pixel (x, y) as T, which has to fit the format.
  template <class T>
  [[nodiscard]] T at(int x, int y, int c = 0) const {
    T value;
    const std::size_t offset =
        static_cast<std::size_t>(x) * bytes_per_pixel(format) + static_cast<std::size_t>(c) * sizeof(T);
    std::memcpy(&value, row(y).subspan(offset, sizeof(T)).data(), sizeof(T));
    return value;
  }
};

/// One picture and when it was taken. Owns its bytes; decoders reuse their memory from frame to frame.
struct Image {
  SourceId source{};
  std::uint64_t sequence = 0;  ///< of the packet it came from; a gap is a lost frame
  /// The exposure's start where `start_of_exposure`, otherwise when the frame had arrived, less the configured latency.
  Time stamp{};
  bool start_of_exposure = false;
  PixelFormat format = PixelFormat::kMono8;
  int width = 0, height = 0;  ///< pixels
  std::size_t stride = 0;     ///< bytes per row
  std::vector<std::byte> bytes;

  /// Makes room for width × height pixels without padding. What the bytes hold afterwards is left open.
  void resize(PixelFormat f, int w, int h) {
    format = f;
    width = w;
    height = h;
    stride = static_cast<std::size_t>(w) * bytes_per_pixel(f);
    bytes.resize(stride * static_cast<std::size_t>(h));
  }
  /// Valid until the image changes.
  [[nodiscard]] ImageView view() const { return {format, width, height, stride, bytes}; }
};

/// One frame of a thermal camera.
struct ThermalImage {
  Image values;  ///< kCelsius where the sensor says what its counts mean, otherwise kMono16: raw counts
  Image
      stretched;  ///< kMono8, the same size: `values` spread over 0…255, warm is bright; for detectors and for looking
  /// A flat-field correction is imminent or running, or ended less than a second ago: the picture may be frozen or
  /// wrong.
  bool correcting = false;

  [[nodiscard]] bool radiometric() const { return values.format == PixelFormat::kCelsius; }
};

}  // namespace cairn
