// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/pictures/map_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "onboard/report/labels/label_measures.hpp"

namespace cairn::report {
namespace {

constexpr int kKeys = 1 << mapping::SemanticOcTree::kDepth;
constexpr int kZeroKey = kKeys / 2;  // the voxel whose lower corner is the origin

/// A leaf as a cube of voxels: keys from `low`, `edge` of them along each axis.
struct Cube {
  std::array<int, 3> low;
  int edge;
  bool occupied;
  std::uint8_t class_id;  // or kNoClass
};

/// Which of x, y, z go to the right, upwards and towards the viewer; the last one's sign.
struct Axes {
  std::size_t right, up, near;
  int near_sign;
};
constexpr std::array<Axes, 3> kAxes{Axes{.right = 0, .up = 1, .near = 2, .near_sign = 1},
                                    Axes{.right = 0, .up = 2, .near = 1, .near_sign = -1},
                                    Axes{.right = 1, .up = 2, .near = 0, .near_sign = 1}};
const Axes& axes_of(MapView view) { return kAxes[static_cast<std::size_t>(view)]; }

struct Heights {
  int low, high;  // z keys, inclusive
};

template <class Visit>
void for_each_cube(const mapping::SemanticOcTree& map, const Heights& heights, Visit&& visit) {
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const mapping::VoxelLabel label = label_of(map, *leaf);
    const Cube cube{{key[0], key[1], key[2]},
                    1 << (mapping::SemanticOcTree::kDepth - leaf.getDepth()),
                    map.isNodeOccupied(*leaf),
                    label.any() ? static_cast<std::uint8_t>(label.class_id()) : kNoClass};
    if (cube.low[2] <= heights.high && cube.low[2] + cube.edge > heights.low) visit(cube);
  }
}

int z_key(double z, double resolution, double offset) {
  return static_cast<int>(std::clamp(std::floor(z / resolution + offset) + kZeroKey, 0.0, kKeys - 1.0));
}

Heights asked_for(const MapPictureOptions& options, double resolution) {
  // A voxel is in when its centre is: shifting by half a voxel turns centres into lower corners.
  const int low = options.height_min_m ? z_key(*options.height_min_m, resolution, 0.5 - 1e-9) : 0;
  const int high = options.height_max_m ? z_key(*options.height_max_m, resolution, -0.5 + 1e-9) : kKeys - 1;
  return {low, high};
}

/// Counts areas without touching every cell of every rectangle: corners now, sums at the end.
class AreaCounter {
 public:
  AreaCounter(int width, int height)
      : width_(width),
        height_(height),
        corners_(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1)) {}

  /// Inclusive cells.
  void add(int x0, int y0, int x1, int y1) {
    corner(x0, y0) += 1;
    corner(x1 + 1, y0) -= 1;
    corner(x0, y1 + 1) -= 1;
    corner(x1 + 1, y1 + 1) += 1;
  }
  [[nodiscard]] std::vector<std::uint8_t> covered() const {
    const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
    std::vector<std::uint8_t> out(width * height);
    std::vector<std::int64_t> over(width);  // how many rectangles lie over the cells of the row
    for (std::size_t y = 0; y < height; ++y) {
      const std::int64_t* corner = corners_.data() + y * (width + 1);
      std::int64_t begun = 0;
      for (std::size_t x = 0; x < width; ++x) {
        begun += corner[x];
        over[x] += begun;
        out[y * width + x] = over[x] > 0 ? 1 : 0;
      }
    }
    return out;
  }

 private:
  std::int64_t& corner(int x, int y) {
    return corners_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x)];
  }
  int width_, height_;
  std::vector<std::int64_t> corners_;
};

class Projector {
 public:
  Projector(const mapping::SemanticOcTree& map, const MapPictureOptions& options)
      : map_(map), options_(options), axes_(axes_of(options.view)), heights_(asked_for(options, map.getResolution())) {
    picture_.view = options.view;
    picture_.voxel_m = map.getResolution();
  }

  Result<MapPicture> run() {
    if (!frame()) return Error{Errc::kNotFound, "nothing to draw: the map is empty between these heights", {}, {}, {}};
    mark_free();
    if (options_.view == MapView::kTop && !options_.height_max_m) cut_below_ceiling();
    mark_occupied();
    span_colours();
    return std::move(picture_);
  }

 private:
  bool frame() {
    std::array<int, 3> low{kKeys, kKeys, kKeys}, high{-1, -1, -1};
    for_each_cube(map_, heights_, [&](const Cube& c) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], c.low[i]);
        high[i] = std::max(high[i], c.low[i] + c.edge - 1);
      }
    });
    if (high[0] < 0) return false;
    right0_ = low[axes_.right];
    up0_ = low[axes_.up];
    const int wide = high[axes_.right] - right0_ + 1, tall = high[axes_.up] - up0_ + 1;
    per_cell_ = (std::max(wide, tall) + options_.max_cells - 1) / options_.max_cells;
    picture_.width = (wide + per_cell_ - 1) / per_cell_;
    picture_.height = (tall + per_cell_ - 1) / per_cell_;
    picture_.cell_m = per_cell_ * picture_.voxel_m;
    picture_.corner_m = picture_.voxel_m * Eigen::Vector2d(right0_ - kZeroKey, up0_ - kZeroKey);
    const auto cells = static_cast<std::size_t>(picture_.width) * static_cast<std::size_t>(picture_.height);
    picture_.filled.assign(cells, 0);
    picture_.nearest_m.assign(cells, std::numeric_limits<float>::lowest());
    picture_.classes.assign(cells, kNoClass);
    return true;
  }

  struct Cells {
    int x0, y0, x1, y1;  // inclusive
  };
  [[nodiscard]] Cells cells_of(const Cube& c) const {
    const int right = c.low[axes_.right] - right0_, up = c.low[axes_.up] - up0_;
    return {right / per_cell_, up / per_cell_, (right + c.edge - 1) / per_cell_, (up + c.edge - 1) / per_cell_};
  }

  void mark_free() {
    AreaCounter area(picture_.width, picture_.height);
    for_each_cube(map_, heights_, [&](const Cube& c) {
      const Cells cells = cells_of(c);
      if (!c.occupied) area.add(cells.x0, cells.y0, cells.x1, cells.y1);
    });
    picture_.free = area.covered();
  }

  // A ceiling is a height, at least a person above the floor, at which much more of the known columns is occupied than
  // the walls take up, and below which most of these columns are free (a terrace has no room below it).
  void cut_below_ceiling() {
    constexpr double kPerson_m = 1.8, kFloorShare = 0.02, kCeilingShare = 0.15, kRough_m = 0.15;
    // A crafted map has 65 536 heights to look at. In cells and nodes: a second or two.
    constexpr double kMostLooks = 256, kLookedAt = 6e7;
    const std::vector<double> area = occupied_per_height();
    const double columns =
        static_cast<double>(std::count(picture_.free.begin(), picture_.free.end(), 1)) * per_cell_ * per_cell_;
    // Noise spreads a plane over two layers.
    const auto both = [&](int z) { return area[static_cast<std::size_t>(z)] + area[static_cast<std::size_t>(z + 1)]; };
    int floor = 0;
    while (floor < kKeys - 2 && (both(floor) == 0 || both(floor) < kFloorShare * columns)) ++floor;
    const int lowest = std::min(kKeys - 2, floor + static_cast<int>(kPerson_m / picture_.voxel_m));
    std::vector<double> between;
    for (int z = floor + 2; z <= std::max(lowest, floor + 2) && z < kKeys - 1; ++z) between.push_back(both(z));
    if (between.empty()) return;
    std::nth_element(between.begin(), between.begin() + static_cast<std::ptrdiff_t>(between.size() / 2), between.end());
    const double walls = between[between.size() / 2];
    const double cost = static_cast<double>(picture_.free.size()) + static_cast<double>(map_.size());
    double looks_left = std::min(kMostLooks, kLookedAt / cost);
    for (int z = lowest; z < kKeys - 1; ++z) {
      if (both(z) - walls < kCeilingShare * columns || both(z) == 0) continue;
      if (--looks_left < 0) return;
      if (!is_hollow_below(z)) continue;
      heights_.high = z - 1 - static_cast<int>(kRough_m / picture_.voxel_m);
      picture_.cut_m = (heights_.high + 1 - kZeroKey) * picture_.voxel_m;
      return;
    }
  }

  [[nodiscard]] std::vector<double> occupied_per_height() const {
    std::vector<double> area(kKeys + 1, 0.0);  // first what begins and ends at a height; whole numbers, so exact
    for_each_cube(map_, heights_, [&](const Cube& c) {
      if (!c.occupied) return;
      area[static_cast<std::size_t>(c.low[2])] += static_cast<double>(c.edge) * c.edge;
      area[static_cast<std::size_t>(c.low[2] + c.edge)] -= static_cast<double>(c.edge) * c.edge;
    });
    std::partial_sum(area.begin(), area.end(), area.begin());
    return area;
  }

  [[nodiscard]] bool is_hollow_below(int ceiling) const {
    AreaCounter above(picture_.width, picture_.height), below(picture_.width, picture_.height);
    for_each_cube(map_, heights_, [&](const Cube& c) {
      const Cells cells = cells_of(c);
      const bool in_ceiling = c.low[2] <= ceiling + 1 && c.low[2] + c.edge > ceiling;
      if (c.occupied && in_ceiling) above.add(cells.x0, cells.y0, cells.x1, cells.y1);
      if (!c.occupied && c.low[2] < ceiling - 1) below.add(cells.x0, cells.y0, cells.x1, cells.y1);
    });
    const std::vector<std::uint8_t> covered = above.covered(), hollow = below.covered();
    std::size_t both = 0;
    for (std::size_t i = 0; i < covered.size(); ++i) both += covered[i] & hollow[i];
    return 2 * both > static_cast<std::size_t>(std::count(covered.begin(), covered.end(), 1));
  }

  void mark_occupied() {
    for_each_cube(map_, heights_, [&](const Cube& c) {
      if (!c.occupied) return;
      const auto nearest = static_cast<float>(nearest_of(c));
      const Cells cells = cells_of(c);
      for (int y = cells.y0; y <= cells.y1; ++y)
        for (int x = cells.x0; x <= cells.x1; ++x) {
          const std::size_t i = picture_.index(x, y);
          picture_.filled[i] += static_cast<std::uint32_t>(c.edge);
          if (nearest <= picture_.nearest_m[i]) continue;
          picture_.nearest_m[i] = nearest;
          picture_.classes[i] = c.class_id;
        }
    });
  }

  [[nodiscard]] double nearest_of(const Cube& c) const {
    const int low = c.low[axes_.near];
    int key = axes_.near_sign > 0 ? low + c.edge - 1 : low;
    if (axes_.near == 2) key = std::min(key, heights_.high);
    return axes_.near_sign * (key - kZeroKey + 0.5) * picture_.voxel_m;
  }

  // From the 2nd to the 98th percentile, so that one bird does not paint the whole map blue.
  void span_colours() {
    std::vector<double> seen;
    for (int row = 0; row < picture_.height; ++row)
      for (int column = 0; column < picture_.width; ++column)
        if (picture_.filled[picture_.index(column, row)] > 0) seen.push_back(picture_.height_of(column, row));
    if (seen.empty()) return;
    std::sort(seen.begin(), seen.end());
    picture_.low_m = seen[seen.size() / 50];
    picture_.high_m = std::max(seen[seen.size() - 1 - seen.size() / 50], picture_.low_m + picture_.voxel_m);
  }

  const mapping::SemanticOcTree& map_;
  const MapPictureOptions& options_;
  const Axes& axes_;
  Heights heights_;
  MapPicture picture_;
  int right0_ = 0, up0_ = 0, per_cell_ = 1;
};

}  // namespace

std::optional<MapView> map_view_from(std::string_view name) {
  if (name == "top") return MapView::kTop;
  if (name == "side") return MapView::kSide;
  if (name == "front") return MapView::kFront;
  return std::nullopt;
}

Eigen::Vector2d project(MapView view, const Eigen::Vector3d& point) {
  const Axes& axes = axes_of(view);
  return {point[static_cast<Eigen::Index>(axes.right)], point[static_cast<Eigen::Index>(axes.up)]};
}

double nearness(MapView view, const Eigen::Vector3d& point) {
  const Axes& axes = axes_of(view);
  return axes.near_sign * point[static_cast<Eigen::Index>(axes.near)];
}

bool MapPicture::labelled() const {
  return std::ranges::any_of(classes, [](std::uint8_t class_id) { return class_id != kNoClass; });
}

double MapPicture::height_of(int column, int row) const {
  return view == MapView::kTop ? static_cast<double>(nearest_m[index(column, row)])
                               : corner_m.y() + (row + 0.5) * cell_m;
}

Result<MapPicture> look_at(const mapping::SemanticOcTree& map, const MapPictureOptions& options) {
  return Projector(map, options).run();
}

}  // namespace cairn::report
