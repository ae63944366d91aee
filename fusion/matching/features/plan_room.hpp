// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::matching {

/// The columns of a plan, row by row.
struct ColumnGrid {
  float cell_m = 0;                                  ///< edge of a column, m
  Eigen::Vector2f corner = Eigen::Vector2f::Zero();  ///< lowest of the first column, m
  Eigen::Vector2i size = Eigen::Vector2i::Ones();    ///< columns along x and y

  /// The column at a place (m), which may lie outside.
  [[nodiscard]] Eigen::Vector2i cell_of(const Eigen::Vector2f& at) const {
    return ((at - corner) / cell_m).array().floor().cast<int>();
  }
  /// The number of a column.
  [[nodiscard]] std::size_t slot(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(size.x()) + static_cast<std::size_t>(cell.x());
  }
  /// How many columns there are.
  [[nodiscard]] std::size_t count() const { return slot({0, size.y()}); }
};

/// Adds the space that a map observed free to the columns in which it lies, in m³. A column is full with `full_m3`.
/// What would make it fuller is not looked for, from the lowest upwards, because it takes time and says no more.
/// `turn`: of the plan's frame against the map's. `room_m3`: one number for each column; full for those of no interest.
void add_room(const mapping::SemanticOcTree& map, const Eigen::Matrix3f& turn, const ColumnGrid& columns, float full_m3,
              std::vector<float>& room_m3);

}  // namespace cairn::matching
