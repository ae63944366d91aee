// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/wall_cells.hpp"

namespace cairn::people {
namespace {

// Standard deviations along and across the line, m. A LiDAR's noise is about 0.02 m. 0.2 m along is a length of 0.7 m.
constexpr double kLong = 0.2, kThin = 0.03;
constexpr std::uint32_t kFewestAround = 6;  // points

}  // namespace

WallCells::WallCells(int side_cells)
    : side_(side_cells), slot_(static_cast<std::size_t>(side_cells) * static_cast<std::size_t>(side_cells), 0) {}

void WallCells::clear() {
  for (const std::uint32_t cell : filled_) slot_[cell] = 0;
  filled_.clear();
  spreads_.clear();
}

void WallCells::add(std::uint32_t cell, const Eigen::Vector2f& point_m) {
  if (slot_[cell] == 0) {
    filled_.push_back(cell);
    spreads_.emplace_back();
    slot_[cell] = static_cast<std::uint32_t>(filled_.size());
  }
  spreads_[slot_[cell] - 1].add(point_m);
}

void WallCells::judge() {
  wall_.assign(filled_.size(), 0);
  for (std::size_t i = 0; i < filled_.size(); ++i) {
    PlanSpread around;
    for (int row = -kReach; row <= kReach; ++row) {
      const auto first = static_cast<std::uint32_t>(static_cast<int>(filled_[i]) + row * side_ - kReach);
      for (std::uint32_t cell = first; cell <= first + 2 * kReach; ++cell)
        if (slot_[cell] != 0) around.add(spreads_[slot_[cell] - 1]);
    }
    wall_[i] = around.count() >= kFewestAround && around.on_a_line(kLong, kThin) ? 1 : 0;
  }
}

}  // namespace cairn::people
