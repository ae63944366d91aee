// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/canvas.hpp"

#include <algorithm>
#include <cmath>

#include "onboard/report/pictures/font.hpp"

namespace cairn::report {
namespace {

// Pieces beyond this many pixels lie mostly outside of any picture: they are not worth cutting into dashes.
constexpr double kLongest = 1e5;

struct Box {
  int x0, y0, x1, y1;  // inclusive; empty when x1 < x0
};

/// Pixels of the image within `margin` of the rectangle that a and b span.
Box pixels_around(const Raster& image, const Pixel& a, const Pixel& b, double margin) {
  const auto low = [&](double v, int size) {
    return static_cast<int>(std::clamp(std::floor(v - margin), 0.0, size * 1.0));
  };
  const auto high = [&](double v, int size) {
    return static_cast<int>(std::clamp(std::ceil(v + margin), -1.0, size - 1.0));
  };
  return {low(std::min(a.x(), b.x()), image.width()), low(std::min(a.y(), b.y()), image.height()),
          high(std::max(a.x(), b.x()), image.width()), high(std::max(a.y(), b.y()), image.height())};
}

double distance_to_segment(const Pixel& p, const Pixel& a, const Pixel& b) {
  const Pixel ab = b - a;
  const double length2 = ab.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - share * ab).norm();
}

void draw_segment(Raster& image, const Pixel& a, const Pixel& b, const Stroke& stroke, std::vector<float>& coverage) {
  const double radius = stroke.width / 2;
  const Box box = pixels_around(image, a, b, radius + 1);
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      const double inside = radius + 0.5 - distance_to_segment({x + 0.5, y + 0.5}, a, b);
      float& c =
          coverage[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) + static_cast<std::size_t>(x)];
      c = std::max(c, static_cast<float>(std::clamp(inside, 0.0, 1.0)));
    }
}

/// Cuts a polyline into dashes and hands every straight piece to `draw`.
template <class Draw>
void for_each_dash(std::span<const Pixel> points, double dash, Draw&& draw) {
  double walked = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Pixel a = points[i - 1], step = points[i] - a;
    const double length = step.norm();
    if (!std::isfinite(length)) continue;
    if (dash <= 0 || length > kLongest) {
      draw(a, points[i]);
      continue;
    }
    for (double s = 0; s < length;) {
      const double phase = std::fmod(walked + s, 2 * dash);
      const double end = std::min(length, s + std::max(1e-3, (phase < dash ? dash : 2 * dash) - phase));
      if (phase < dash) draw(a + step * (s / length), a + step * (end / length));
      s = end;
    }
    walked = std::fmod(walked + length, 2 * dash);
  }
}

const Glyph* glyph_of(char c) {
  const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto glyph = std::find_if(kFont.begin(), kFont.end(), [&](const Glyph& g) { return g.symbol == lower; });
  return glyph == kFont.end() ? nullptr : &*glyph;
}

}  // namespace

void fill_rectangle(Raster& image, int x, int y, int width, int height, Rgba colour) {
  for (int v = std::max(0, y); v < std::min(image.height(), y + height); ++v)
    for (int u = std::max(0, x); u < std::min(image.width(), x + width); ++u)
      image.at(u, v) = blend(image.at(u, v), colour);
}

void draw_line(Raster& image, std::span<const Pixel> points, const Stroke& stroke) {
  // Coverage is collected first, so that a half-transparent line is not darker where its segments meet.
  std::vector<float> coverage(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
  for_each_dash(points, stroke.dash,
                [&](const Pixel& a, const Pixel& b) { draw_segment(image, a, b, stroke, coverage); });
  std::size_t i = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x, ++i)
      if (coverage[i] > 0) image.at(x, y) = blend(image.at(x, y), stroke.colour, static_cast<double>(coverage[i]));
}

void draw_disc(Raster& image, const Pixel& centre, double radius, Rgba colour) {
  draw_line(image, std::array{centre, centre}, {colour, 2 * radius, 0});
}

void draw_text(Raster& image, int x, int y, std::string_view text, int scale, Rgba colour) {
  for (const char c : text) {
    if (const Glyph* glyph = glyph_of(c))
      for (int row = 0; row < kGlyphHeight; ++row)
        for (int column = 0; column < 5; ++column)
          if ((glyph->rows[static_cast<std::size_t>(row)] >> (4 - column)) & 1)
            fill_rectangle(image, x + column * scale, y + row * scale, scale, scale, colour);
    x += kGlyphWidth * scale;
  }
}

int text_width(std::string_view text, int scale) {
  return text.empty() ? 0 : (static_cast<int>(text.size()) * kGlyphWidth - 1) * scale;
}

}  // namespace cairn::report
