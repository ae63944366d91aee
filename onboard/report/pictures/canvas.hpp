// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "onboard/report/pictures/raster.hpp"

namespace cairn::report {

/// Pixel coordinates: x to the right, y down, (0, 0) the upper left corner of the upper left pixel. Whatever lies
/// outside of the image is cut off.
using Pixel = Eigen::Vector2d;

/// How a line is drawn.
struct Stroke {
  Rgba colour;
  double width = 1.0;  ///< pixels
  double dash = 0.0;   ///< length of a dash and of the gap after it, pixels; 0: solid
};

void fill_rectangle(Raster& image, int x, int y, int width, int height, Rgba colour);
/// Smooth-edged.
void draw_line(Raster& image, std::span<const Pixel> points, const Stroke& stroke);
void draw_disc(Raster& image, const Pixel& centre, double radius, Rgba colour);

inline constexpr int kGlyphWidth = 6, kGlyphHeight = 7;  ///< pixels per character at scale 1, with the gap after it
/// A 5×7 raster font with digits, lower-case letters and . - + : = / ( ) _; upper-case letters are drawn as lower-case
/// ones, everything else as a blank. (x, y) is the upper left corner.
void draw_text(Raster& image, int x, int y, std::string_view text, int scale, Rgba colour);
[[nodiscard]] int text_width(std::string_view text, int scale);

}  // namespace cairn::report
