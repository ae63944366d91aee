// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/ground_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::people {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::infinity();
// The ground may rise or fall so much. Lower points are mirrored ones, higher ones walls.
constexpr float kStep = 0.3F, kSlope = 0.15F;
// Rings of a LiDAR are so far apart that between them only bodies are seen: cells farther away tell of the ground, too.
constexpr int kAround = 2;
constexpr float kUsualSlope = 0.05F;

}  // namespace

GroundGrid::GroundGrid(double farthest_m)
    : side_(2 * static_cast<int>(std::ceil(farthest_m / kCell)) + 1 + 2 * kAround),
      low_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), kUnseen) {}

int GroundGrid::cell_of(float x, float y) const {
  const float column = std::floor((x - corner_.x()) / kCell), row = std::floor((y - corner_.y()) / kCell);
  const auto side = static_cast<float>(side_);
  if (!(column >= kAround && row >= kAround && column < side - kAround && row < side - kAround))
    return -1;  // those at the rim have not all neighbours
  return static_cast<int>(row) * side_ + static_cast<int>(column);
}

void GroundGrid::fill(std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom,
                      float sensor_height_m) {
  std::ranges::fill(low_, kUnseen);
  corner_ = sensor_odom.head<2>().array() - 0.5F * kCell * static_cast<float>(side_);
  under_robot_ = sensor_odom.z() - sensor_height_m;
  for (const Eigen::Vector3f& p : points_odom) {
    const int cell = cell_of(p.x(), p.y());
    if (cell < 0) continue;
    const float away = (p.head<2>() - sensor_odom.head<2>()).norm();
    if (std::abs(p.z() - under_robot_) > kStep + kSlope * away) continue;
    float& low = low_[static_cast<std::size_t>(cell)];
    low = std::min(low, p.z());
  }
}

float GroundGrid::height(float x, float y) const {
  const int cell = cell_of(x, y);
  if (cell < 0) return under_robot_;
  float low = kUnseen;
  for (int row = -kAround; row <= kAround; ++row)
    for (int column = -kAround; column <= kAround; ++column) {
      const auto away = static_cast<float>(std::max({std::abs(row), std::abs(column), 1}) - 1);
      low = std::min(low, low_[static_cast<std::size_t>(cell + row * side_ + column)] + kUsualSlope * away);
    }
  return low == kUnseen ? under_robot_ : low;
}

}  // namespace cairn::people
