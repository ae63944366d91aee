// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/semantic_class.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::report {

/// Parallel projection. Every picture has z or y upwards and is seen, not mirrored.
enum class MapView {
  kTop,    ///< from above: x to the right, y up
  kSide,   ///< from the robot's right (−y): x to the right, z up
  kFront,  ///< from ahead (+x): y to the right, z up
};
[[nodiscard]] std::optional<MapView> map_view_from(std::string_view name);

/// The picture's coordinates of a point: (right, up) in metres.
[[nodiscard]] Eigen::Vector2d project(MapView view, const Eigen::Vector3d& point);
/// How near the point is to the viewer, in metres along the viewing direction.
[[nodiscard]] double nearness(MapView view, const Eigen::Vector3d& point);

/// Which part of a map is drawn, and from where.
struct MapPictureOptions {
  MapView view = MapView::kTop;
  /// Only voxels with a centre between these heights are drawn. A view from above with no upper limit cuts a building
  /// open below its ceiling, where it finds one.
  std::optional<double> height_min_m, height_max_m;
  int max_cells = 2048;  ///< along the longer side; a larger map gets cells of several voxels
};

/// A map seen along one axis, reduced to cells. Rows go upwards: cell (0, 0) is at the lower left.
struct MapPicture {
  MapView view = MapView::kTop;
  int width = 0, height = 0;  ///< cells
  double cell_m = 0;
  Eigen::Vector2d corner_m = Eigen::Vector2d::Zero();  ///< (right, up) of the lower left corner of cell (0, 0)
  double voxel_m = 0;
  std::vector<std::uint8_t> free;     ///< 1: some voxel of the column is known to be free
  std::vector<std::uint32_t> filled;  ///< occupied voxels in the column; 0: none
  std::vector<float> nearest_m;       ///< nearness() of the occupied voxel that one sees
  std::vector<std::uint8_t> classes;  ///< trainId of the occupied voxel that one sees, or kNoClass
  double low_m = 0, high_m = 0;       ///< heights that the colours span
  std::optional<double> cut_m;        ///< what lies above was left out: the ceiling that was found

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  /// Whether any voxel that one sees has a label.
  [[nodiscard]] bool labelled() const;
  /// Height above z = 0 of what one sees in an occupied cell.
  [[nodiscard]] double height_of(int column, int row) const;
};

/// Error: nothing in the map lies between the heights asked for.
[[nodiscard]] Result<MapPicture> look_at(const mapping::SemanticOcTree& map, const MapPictureOptions& options);

}  // namespace cairn::report
