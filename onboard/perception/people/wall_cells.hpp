// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "onboard/perception/people/plan_spread.hpp"

namespace cairn::people {

/// The cells of a square grid around which the points lie on one straight line in plan: walls, fences, sides of cars.
/// Nobody's body is as straight. So a new piece of a wall is no person, although the map does not know it yet.
class WallCells {
 public:
  explicit WallCells(int side_cells);
  /// Points of a new scan. `cell`: row · side + column, at least kReach from the rim.
  void clear();
  void add(std::uint32_t cell, const Eigen::Vector2f& point_m);
  /// After the last point.
  void judge();
  [[nodiscard]] bool is_wall(std::uint32_t cell) const { return slot_[cell] != 0 && wall_[slot_[cell] - 1] != 0; }

  static constexpr int kReach = 3;  ///< cells on each side that are looked at together

 private:
  int side_;
  std::vector<std::uint32_t> slot_;    // of each cell: number in the vectors below + 1; 0: empty
  std::vector<std::uint32_t> filled_;  // cells
  std::vector<PlanSpread> spreads_;
  std::vector<std::uint8_t> wall_;
};

}  // namespace cairn::people
