// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/view/costmap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "onboard/client/view/distance_field.hpp"

namespace cairn::client {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// Unseen ground under free space counts as level, so far from where ground was seen: a LiDAR sees no floor near the
// robot. In metres.
constexpr double kUnseenGround_m = 2;

enum class Cell : std::uint8_t { kNotReached, kDrivable, kBlocked };

/// What a column of voxels is for a robot that comes from ground of a given height.
struct Column {
  Cell cell = Cell::kNotReached;
  double ground_m = 0;
  bool seen = false;  // the ground itself was seen
};

class Ground {
 public:
  Ground(const PlannerView& view, const CostmapConfig& config, Costmap& map) : view_(view), config_(config), map_(map) {
    const auto count = static_cast<std::size_t>(map.cells) * static_cast<std::size_t>(map.cells);
    cells_.resize(count);
    unseen_m_.resize(count);
  }

  /// Follows the ground from the middle.
  void follow(double start_m) {
    const int middle = map_.cells / 2;
    enter(middle, middle, start_m, 0);
    while (!waiting_.empty()) {
      const auto [x, y] = waiting_.front();
      waiting_.pop_front();
      const std::size_t here = index(x, y);
      for (const auto& [dx, dy] : kNeighbours)
        enter(x + dx, y + dy, static_cast<double>(map_.ground_m[here]), unseen_m_[here]);
    }
  }
  [[nodiscard]] Cell cell(std::size_t i) const { return cells_[i]; }

 private:
  static constexpr std::array<std::pair<int, int>, 4> kNeighbours{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.cells) + static_cast<std::size_t>(x);
  }
  void enter(int x, int y, double from_m, double unseen_m) {
    if (x < 0 || y < 0 || x >= map_.cells || y >= map_.cells) return;
    const std::size_t i = index(x, y);
    if (cells_[i] == Cell::kDrivable || (cells_[i] == Cell::kBlocked)) return;
    const Column column = look(x, y, from_m);
    if (column.cell == Cell::kNotReached) return;
    unseen_m_[i] = column.seen ? 0 : unseen_m + map_.resolution_m;
    if (unseen_m_[i] > kUnseenGround_m) return;
    cells_[i] = column.cell;
    if (column.cell != Cell::kDrivable) return;
    map_.ground_m[i] = static_cast<float>(column.ground_m);
    waiting_.emplace_back(x, y);
  }
  /// From a step below the ground to the robot's height above it.
  [[nodiscard]] Column look(int x, int y, double from_m) const {
    const double voxel = map_.resolution_m;
    const Eigen::Vector3d foot(map_.x_m + (x + 0.5) * voxel, map_.y_m + (y + 0.5) * voxel, 0);
    const auto at = [&](double z) { return view_.occupancy(foot + Eigen::Vector3d(0, 0, z)); };
    std::optional<double> ground;
    bool free = false;
    for (double z = from_m - config_.step_m - voxel; z < from_m + config_.step_m + voxel / 2; z += voxel)
      if (at(z) == Occupancy::kOccupied) ground = z + voxel / 2;
    const double base = ground.value_or(from_m);
    for (double z = base + voxel; z < base + config_.height_m; z += voxel) {
      const Occupancy occupancy = at(z);
      if (occupancy == Occupancy::kOccupied) return {.cell = Cell::kBlocked, .ground_m = base};
      free = free || occupancy == Occupancy::kFree;
    }
    if (!ground && !free) return {};
    if (!ground && at(from_m - config_.step_m - voxel) == Occupancy::kFree)
      return {.cell = Cell::kBlocked, .ground_m = base};  // a drop
    return {.cell = Cell::kDrivable, .ground_m = base, .seen = ground.has_value()};
  }

  const PlannerView& view_;
  const CostmapConfig& config_;
  Costmap& map_;
  std::vector<Cell> cells_;
  std::vector<double> unseen_m_;  // way over ground that was not seen
  std::deque<std::pair<int, int>> waiting_;
};

std::uint8_t cost_at(double distance_m, const CostmapConfig& config) {
  if (distance_m <= config.inscribed_m) return Costmap::kInscribed;
  if (distance_m > config.inflation_m) return Costmap::kFree;
  constexpr double kMost = 252;
  return static_cast<std::uint8_t>(kMost * std::exp(-config.scaling * (distance_m - config.inscribed_m)));
}

}  // namespace

Costmap make_costmap(const PlannerView& view, const SE3& T_odom_base, const CostmapConfig& config) {
  Costmap map;
  map.resolution_m = view.resolution_m();
  constexpr double kMostCells = 2000;
  map.cells = static_cast<int>(std::clamp(std::ceil(config.size_m / map.resolution_m), 1.0, kMostCells));
  const Eigen::Vector3d& base = T_odom_base.translation();
  const auto corner = [&](double middle) {
    return (std::floor(middle / map.resolution_m) - map.cells / 2) * map.resolution_m;  // on the map's own grid
  };
  map.x_m = corner(base.x());
  map.y_m = corner(base.y());
  const auto count = static_cast<std::size_t>(map.cells) * static_cast<std::size_t>(map.cells);
  map.ground_m.assign(count, kNone);
  map.cost.assign(count, Costmap::kUnknown);
  Ground ground(view, config, map);
  ground.follow(base.z() - config.base_height_m);

  std::vector<std::uint8_t> blocked(count);
  for (std::size_t i = 0; i < count; ++i) blocked[i] = ground.cell(i) == Cell::kBlocked ? 1 : 0;
  const auto distance = distances_2d(blocked, map.cells, map.cells, map.resolution_m);
  for (std::size_t i = 0; i < count; ++i) {
    if (ground.cell(i) == Cell::kBlocked) map.cost[i] = Costmap::kLethal;
    if (ground.cell(i) == Cell::kDrivable) map.cost[i] = cost_at(static_cast<double>(distance[i]), config);
  }
  return map;
}

std::vector<std::int8_t> Costmap::occupancy_grid() const {
  std::vector<std::int8_t> grid(cost.size());
  std::ranges::transform(cost, grid.begin(), [](std::uint8_t c) {
    constexpr int kMost = 100;
    return c == kUnknown ? std::int8_t{-1} : static_cast<std::int8_t>(kMost * c / kLethal);
  });
  return grid;
}

}  // namespace cairn::client
