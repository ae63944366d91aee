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

/// Bytes from one pixel of a row to the next.
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

/// A rectangle of pixels in another's memory: a whole image or a part of one. Row 0 is the top, column 0 the left.
struct ImageView {
  PixelFormat format = PixelFormat::kMono8;
  int width = 0, height = 0;         ///< pixels
  std::size_t stride = 0;            ///< bytes from one row to the next, at least width · bytes_per_pixel
  std::span<const std::byte> bytes;  ///< from the first pixel to the last; padding after the last row may be missing

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

/// One picture and when it was taken. It owns its bytes. Decoders reuse the memory from frame to frame.
struct Image {
  SourceId source{};
  std::uint64_t sequence = 0;  ///< of the packet it came from; a gap is a lost frame
  /// The start of the exposure if `start_of_exposure` is set, else the arrival of the frame. The configured latency is
  /// subtracted.
  Time stamp{};
  bool start_of_exposure = false;
  PixelFormat format = PixelFormat::kMono8;
  int width = 0, height = 0;  ///< pixels
  std::size_t stride = 0;     ///< bytes per row
  std::vector<std::byte> bytes;

  /// Makes room for width × height pixels without padding. The content of the bytes is then undefined.
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
  Image values;     ///< kCelsius where the sensor says what its counts mean, otherwise kMono16: raw counts
  Image stretched;  ///< kMono8 of the same size: `values` spread over 0…255, warm is bright; for detectors and people
  /// A flat-field correction is imminent or running, or ended less than a second ago. The picture may be frozen or
  /// wrong.
  bool correcting = false;

  /// True when the values are temperatures.
  [[nodiscard]] bool radiometric() const { return values.format == PixelFormat::kCelsius; }
};

}  // namespace cairn
