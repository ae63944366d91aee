// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/result.hpp"

namespace cairn::report {

/// sRGB with straight (not premultiplied) alpha.
struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  friend bool operator==(const Rgba&, const Rgba&) = default;
};

/// `over` laid on `under`, with the alpha of `over` scaled by `coverage` (0…1).
[[nodiscard]] Rgba blend(Rgba under, Rgba over, double coverage = 1.0);
/// Linear mixture: share 0 is a, 1 is b.
[[nodiscard]] Rgba mix(Rgba a, Rgba b, double share);

/// A drawn picture, rows from top to bottom. What a camera sends is an Image (hal/image.hpp).
class Raster {
 public:
  Raster(int width, int height, Rgba fill) : width_(width), height_(height), pixels_(size_of(width, height), fill) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  [[nodiscard]] Rgba& at(int x, int y) { return pixels_[index(x, y)]; }
  [[nodiscard]] const Rgba& at(int x, int y) const { return pixels_[index(x, y)]; }
  [[nodiscard]] const Rgba* data() const { return pixels_.data(); }

 private:
  static std::size_t size_of(int w, int h) { return static_cast<std::size_t>(w) * static_cast<std::size_t>(h); }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<Rgba> pixels_;
};

/// The same picture gives the same bytes.
Result<std::vector<std::byte>> encode_png(const Raster& image);

}  // namespace cairn::report
