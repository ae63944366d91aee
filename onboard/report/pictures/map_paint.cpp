// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/map_paint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cairn::report {
namespace {

constexpr Rgba kUnknown{0xd5, 0xda, 0xe1, 255}, kFree{0xfb, 0xfc, 0xfd, 255}, kInk{0x1b, 0x23, 0x2e, 255};
constexpr Rgba kTruth{0x1b, 0x23, 0x2e, 255}, kHalo{255, 255, 255, 190};
constexpr double kMaxPixels = 1e8;

double longer_m(const MapPicture& p) { return std::max(p.width, p.height) * p.cell_m; }

// Light from the upper left, as maps have it.
double slope_light(const MapPicture& p, int column, int row) {
  const auto nearest = [&](int c, int r) {
    const bool inside = c >= 0 && r >= 0 && c < p.width && r < p.height && p.filled[p.index(c, r)] > 0;
    return static_cast<double>(p.nearest_m[inside ? p.index(c, r) : p.index(column, row)]);
  };
  const double east = (nearest(column + 1, row) - nearest(column - 1, row)) / (2 * p.cell_m);
  const double north = (nearest(column, row + 1) - nearest(column, row - 1)) / (2 * p.cell_m);
  return std::clamp(0.12 * (east - north), -0.3, 0.25);
}

Rgba lit(Rgba colour, double light) {
  return light >= 0 ? mix(colour, {255, 255, 255, colour.a}, light) : mix(colour, {0, 0, 0, colour.a}, -light);
}

/// One pixel for each occupied cell, row 0 on top; the rest is transparent.
template <class ColourOf>
Raster painted(const MapPicture& p, ColourOf&& colour_of) {
  Raster image(p.width, p.height, {0, 0, 0, 0});
  for (int row = 0; row < p.height; ++row)
    for (int column = 0; column < p.width; ++column)
      if (p.filled[p.index(column, row)] != 0) image.at(column, p.height - 1 - row) = colour_of(column, row);
  return image;
}

/// Where things go on the finished picture.
struct Layout {
  int scale_x, scale_y;  // upper left corner of the map
  int map_width, map_height;
  int text;  // font scale
  double pixels_per_m;
  const MapPicture* picture;

  [[nodiscard]] Pixel at(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d p = (point - picture->corner_m) * pixels_per_m;
    return {scale_x + p.x(), scale_y + map_height - p.y()};
  }
};

Layout layout_of(const MapPicture& p, double pixels_per_m, int text) {
  const auto pixels = [&](int cells) {
    return std::max(1, static_cast<int>(std::lround(cells * p.cell_m * pixels_per_m)));
  };
  return {.scale_x = 44 * text,
          .scale_y = 14 * text,
          .map_width = pixels(p.width),
          .map_height = pixels(p.height),
          .text = text,
          .pixels_per_m = pixels_per_m,
          .picture = &p};
}

void put_map(Raster& image, const Layout& layout, bool classes) {
  const MapPicture& p = *layout.picture;
  const Raster occupied = classes ? paint_classes(p) : paint_occupied(p);
  for (int y = 0; y < layout.map_height; ++y)
    for (int x = 0; x < layout.map_width; ++x) {
      const int column = std::min(p.width - 1, static_cast<int>((x + 0.5) / (layout.pixels_per_m * p.cell_m)));
      const int row = std::min(p.height - 1, static_cast<int>((y + 0.5) / (layout.pixels_per_m * p.cell_m)));
      const bool free = p.free[p.index(column, p.height - 1 - row)] != 0;
      image.at(layout.scale_x + x, layout.scale_y + y) = blend(free ? kFree : kUnknown, occupied.at(column, row));
    }
}

std::string metres(double value) { return fmt::format("{:g}", value == 0 ? 0.0 : value); }

void draw_grid(Raster& image, const Layout& layout) {
  const MapPicture& p = *layout.picture;
  const Rgba faint{kInk.r, kInk.g, kInk.b, 26};
  const double step = round_below(160 * layout.text / layout.pixels_per_m);
  const Eigen::Vector2d end = p.corner_m + p.cell_m * Eigen::Vector2d(p.width, p.height);
  const int bottom = layout.scale_y + layout.map_height, t = layout.text;
  for (double x = std::ceil(p.corner_m.x() / step) * step; x <= end.x(); x += step) {
    const int u = static_cast<int>(layout.at({x, 0}).x());
    fill_rectangle(image, u, layout.scale_y, 1, layout.map_height, faint);
    draw_text(image, u - text_width(metres(x), t) / 2, bottom + 4 * t, metres(x), t, kInk);
  }
  for (double y = std::ceil(p.corner_m.y() / step) * step; y <= end.y(); y += step) {
    const int v = static_cast<int>(layout.at({0, y}).y());
    fill_rectangle(image, layout.scale_x, v, layout.map_width, 1, faint);
    draw_text(image, layout.scale_x - 4 * t - text_width(metres(y), t), v - 3 * t, metres(y), t, kInk);
  }
  const bool top = p.view == MapView::kTop;
  draw_text(image, layout.scale_x + layout.map_width + 4 * t, bottom + 4 * t, p.view == MapView::kFront ? "y m" : "x m",
            t, kInk);
  draw_text(image, layout.scale_x - 4 * t - text_width("y m", t), 3 * t, top ? "y m" : "z m", t, kInk);
}

void draw_paths(Raster& image, const Layout& layout, const std::vector<MapPath>& paths) {
  const double width = 1.5 * layout.text;
  for (const MapPath& path : paths) {
    std::vector<Pixel> points;
    for (const Eigen::Vector2d& p : path.points) points.push_back(layout.at(p));
    if (points.empty()) continue;
    if (!path.dashed) draw_line(image, points, {kHalo, 2 * width + 1, 0});
    draw_line(image, points,
              {path.dashed ? kTruth : path.colour, path.dashed ? width * 0.8 : width, path.dashed ? 4.0 * width : 0});
    if (path.dashed) continue;
    draw_disc(image, points.front(), 2.2 * width, {255, 255, 255, 255});
    draw_disc(image, points.front(), 1.4 * width, {0x2e, 0x8b, 0x57, 255});
    draw_disc(image, points.back(), 2.2 * width, {255, 255, 255, 255});
    draw_disc(image, points.back(), 1.4 * width, path.colour);
  }
}

/// Over all paths, and inside of the picture.
void draw_names(Raster& image, const Layout& layout, const std::vector<MapPath>& paths) {
  const int t = layout.text;
  for (const MapPath& path : paths) {
    if (path.name.empty() || path.points.empty()) continue;
    const Pixel end = layout.at(path.points.back());
    const int width = text_width(path.name, t) + 4 * t, height = (kGlyphHeight + 4) * t;
    const int x = std::clamp(static_cast<int>(end.x()) + 5 * t, 0, std::max(0, image.width() - width));
    const int y = std::clamp(static_cast<int>(end.y()) - height / 2, 0, std::max(0, image.height() - height));
    fill_rectangle(image, x, y, width, height, {255, 255, 255, 220});
    draw_text(image, x + 2 * t, y + 2 * t, path.name, t, path.colour);
  }
}

void draw_scale_bar(Raster& image, const Layout& layout) {
  const int t = layout.text;
  const double length = round_below(std::max(1.0, layout.map_width / 4.0) / layout.pixels_per_m);
  const int pixels = std::max(1, static_cast<int>(std::lround(length * layout.pixels_per_m)));
  const int x = layout.scale_x, y = image.height() - 16 * t;
  fill_rectangle(image, x, y, pixels, 2 * t, kInk);
  fill_rectangle(image, x, y - 2 * t, t, 6 * t, kInk);
  fill_rectangle(image, x + pixels - t, y - 2 * t, t, 6 * t, kInk);
  draw_text(image, x + pixels + 5 * t, y - 2 * t, metres(length) + " m", t, kInk);
}

constexpr int kClassRow = 11;  // pixels of the legend at text scale 1

void draw_class_legend(Raster& image, const Layout& layout) {
  const int t = layout.text, x = layout.scale_x + layout.map_width + 10 * t;
  int y = layout.scale_y;
  const auto row = [&](std::uint8_t class_id, std::string_view name) {
    fill_rectangle(image, x, y, 9 * t, 8 * t, class_colour(class_id));
    draw_text(image, x + 12 * t, y, name, t, kInk);
    y += kClassRow * t;
  };
  for (const std::uint8_t class_id : classes_in(*layout.picture)) row(class_id, kSemanticClasses[class_id].name);
  row(kNoClass, "no label");
}

void draw_legend(Raster& image, const Layout& layout) {
  const MapPicture& p = *layout.picture;
  const int t = layout.text, x = layout.scale_x + layout.map_width + 10 * t;
  const int height = std::clamp(layout.map_height - 24 * t, 30 * t, 160 * t), y = layout.scale_y + 14 * t;
  draw_text(image, x, layout.scale_y, "z m", t, kInk);
  for (int i = 0; i < height; ++i) fill_rectangle(image, x, y + i, 9 * t, 1, height_colour(1 - (i + 0.5) / height));
  constexpr int kMarks = 3;
  for (int i = 0; i < kMarks; ++i) {
    const double share = static_cast<double>(i) / (kMarks - 1);
    const std::string text = fmt::format("{:.1f}", p.low_m + share * (p.high_m - p.low_m));
    draw_text(image, x + 12 * t, y + static_cast<int>((1 - share) * (height - 7 * t)), text, t, kInk);
  }
}

}  // namespace

double round_below(double limit) {
  const double power = std::pow(10, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= limit) return factor * power;
  return power;
}

Rgba height_colour(double share) {
  constexpr std::array<Rgba, 6> kStops{Rgba{0x2c, 0x3e, 0x8f}, {0x1f, 0x77, 0xb0}, {0x1c, 0x9a, 0x8d},
                                       {0x6a, 0xae, 0x45},     {0xe2, 0x9d, 0x2e}, {0xc7, 0x3e, 0x2c}};
  const double at = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  return mix(kStops[below], kStops[below + 1], at - static_cast<double>(below));
}

Rgba class_colour(std::uint8_t class_id) {
  if (class_id >= kSemanticClasses.size()) return {205, 205, 205, 255};
  const SemanticClass& c = kSemanticClasses[class_id];
  return {c.r, c.g, c.b, 255};
}

std::vector<std::uint8_t> classes_in(const MapPicture& picture) {
  std::vector<std::uint8_t> found;
  for (std::size_t i = 0; i < kSemanticClasses.size(); ++i)
    if (const auto id = static_cast<std::uint8_t>(i); std::ranges::find(picture.classes, id) != picture.classes.end())
      found.push_back(id);
  return found;
}

Raster paint_occupied(const MapPicture& p) {
  return painted(p, [&](int column, int row) {
    const double share = (p.height_of(column, row) - p.low_m) / std::max(p.high_m - p.low_m, 1e-9);
    Rgba colour = lit(height_colour(share), slope_light(p, column, row));
    colour.a = p.filled[p.index(column, row)] <= 2 ? 150 : 255;
    return colour;
  });
}

Raster paint_classes(const MapPicture& p) {
  return painted(p, [&](int column, int row) {
    return lit(class_colour(p.classes[p.index(column, row)]), slope_light(p, column, row));
  });
}

Raster paint_free(const MapPicture& p) {
  Raster image(p.width, p.height, {255, 255, 255, 0});
  for (int row = 0; row < p.height; ++row)
    for (int column = 0; column < p.width; ++column)
      if (p.free[p.index(column, row)] != 0) image.at(column, p.height - 1 - row).a = 255;
  return image;
}

double pixels_per_metre(const MapPicture& picture, const MapDrawing& drawing) {
  return drawing.pixels_per_m > 0 ? drawing.pixels_per_m : 1400 / longer_m(picture);
}

Result<Raster> draw_map(const MapPicture& picture, const MapDrawing& drawing) {
  const double pixels_per_m = pixels_per_metre(picture, drawing);
  const double pixels = std::max(1.0, picture.width * picture.cell_m * pixels_per_m) *
                        std::max(1.0, picture.height * picture.cell_m * pixels_per_m);
  if (!(pixels <= kMaxPixels))
    return Error{Errc::kLimit, "the picture would be too large", {}, {}, "choose fewer pixels per metre"};
  const int text = longer_m(picture) * pixels_per_m > 700 ? 2 : 1;
  const Layout layout = layout_of(picture, pixels_per_m, text);
  const int legend = drawing.classes ? kClassRow * static_cast<int>(classes_in(picture).size() + 1) : 64;
  const int height = std::max(layout.map_height, legend * text), beside = drawing.classes ? 108 : 64;
  Raster image(layout.scale_x + layout.map_width + beside * text, layout.scale_y + height + 40 * text,
               {255, 255, 255, 255});
  put_map(image, layout, drawing.classes);
  draw_grid(image, layout);
  draw_paths(image, layout, drawing.paths);
  draw_names(image, layout, drawing.paths);
  drawing.classes ? draw_class_legend(image, layout) : draw_legend(image, layout);
  draw_scale_bar(image, layout);
  return image;
}

}  // namespace cairn::report
