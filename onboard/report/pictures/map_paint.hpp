// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "onboard/report/pictures/canvas.hpp"
#include "onboard/report/pictures/map_picture.hpp"
#include "onboard/report/pictures/raster.hpp"

namespace cairn::report {

/// Colour of a height: share 0 is the lowest, 1 the highest. Readable on light and on dark ground.
[[nodiscard]] Rgba height_colour(double share);
/// Colour of a class, as Cityscapes paints it; grey for kNoClass.
[[nodiscard]] Rgba class_colour(std::uint8_t class_id);
/// The classes that one sees in the picture, in the order of their trainIds.
[[nodiscard]] std::vector<std::uint8_t> classes_in(const MapPicture& picture);

/// Occupied cells alone, one pixel a cell and row 0 on top; everything else is transparent. Colour is height,
/// brightness follows the slope, and columns of one or two voxels (floors) are thinner than walls.
[[nodiscard]] Raster paint_occupied(const MapPicture& picture);
/// The same, but the colour is that of the class.
[[nodiscard]] Raster paint_classes(const MapPicture& picture);
/// Free cells in white, everything else transparent.
[[nodiscard]] Raster paint_free(const MapPicture& picture);

/// A path over the map, already projected: (right, up) in metres.
struct MapPath {
  std::vector<Eigen::Vector2d> points;
  bool dashed = false;  ///< ground truth is dashed, thin and dark
  Rgba colour{0xd8, 0x1b, 0x60, 255};
  std::string name{};  ///< written at its end
};

/// Scale and paths of a picture of a map.
struct MapDrawing {
  double pixels_per_m = 0;  ///< 0: chosen so that the longer side has about 1400 pixels
  std::vector<MapPath> paths;
  bool classes = false;  ///< colours and legend say the class instead of the height
};
[[nodiscard]] double pixels_per_metre(const MapPicture& picture, const MapDrawing& drawing);
/// The finished picture: map, paths, grid, axes, scale bar and legend.
/// Error: it would have more than 100 million pixels.
[[nodiscard]] Result<Raster> draw_map(const MapPicture& picture, const MapDrawing& drawing);

/// 1, 2 or 5 times a power of ten, at most `limit` (> 0): lengths of scale bars and distances of grid lines.
[[nodiscard]] double round_below(double limit);

}  // namespace cairn::report
