// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/ground_grid.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::people {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kUnseen = std::numeric_limits<float>::infinity();
// The ground may rise or fall so much. Lower points are mirrored ones, higher ones walls.
constexpr float kStep = 0.3F, kSlope = 0.3F;
// Rings of a LiDAR are so far apart that between them only bodies are seen: cells farther away tell of the ground, too.
constexpr int kAround = 2;             // cells whose lowest points may be the ground's
constexpr float kUnsureSlope = 0.05F;  // of the plane, from one cell to the next
constexpr int kSlopeAround = 4;        // cells that tell of the slope
// Lowest points of cells without visible ground lie above the plane. They hardly count (expectiles: Newey and Powell,
// 1987). Where little is seen, the plane stays level.
constexpr int kRounds = 4;
constexpr float kAbove = 0.02F, kNear = 0.05F;  // weight, and m above the plane from which it is taken
constexpr float kLevel = 4.0F;                  // m², of a prior at slope 0, beside a weight of 1 for each cell

}  // namespace

GroundGrid::GroundGrid(double farthest_m)
    : side_(2 * static_cast<int>(std::ceil(farthest_m / kCell)) + 1 + 2 * kSlopeAround),
      low_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), Vector3f::Constant(kUnseen)),
      ground_(low_.size()),
      computed_(low_.size(), 0) {}

int GroundGrid::cell_of(float x, float y) const {
  const float column = std::floor((x - corner_.x()) / kCell), row = std::floor((y - corner_.y()) / kCell);
  const auto side = static_cast<float>(side_ - kSlopeAround);
  if (!(column >= kSlopeAround && row >= kSlopeAround && column < side && row < side))
    return -1;  // those at the rim have not all neighbours
  return static_cast<int>(row) * side_ + static_cast<int>(column);
}

Vector2f GroundGrid::middle_of(int cell) const {
  return corner_ + kCell * Vector2f(static_cast<float>(cell % side_) + 0.5F, static_cast<float>(cell / side_) + 0.5F);
}

void GroundGrid::fill(std::span<const Vector3f> points_odom, const Vector3f& sensor_odom, float sensor_height_m) {
  std::ranges::fill(low_, Vector3f(0, 0, kUnseen));
  std::ranges::fill(computed_, std::uint8_t{0});
  corner_ = sensor_odom.head<2>().array() - 0.5F * kCell * static_cast<float>(side_);
  under_robot_ = sensor_odom.z() - sensor_height_m;
  for (const Vector3f& p : points_odom) {
    const int cell = cell_of(p.x(), p.y());
    if (cell < 0) continue;
    const float away = (p.head<2>() - sensor_odom.head<2>()).norm();
    if (std::abs(p.z() - under_robot_) > kStep + kSlope * away) continue;
    Vector3f& low = low_[static_cast<std::size_t>(cell)];
    if (p.z() < low.z()) low = p;
  }
}

/// visit(point relative to the middle of the cell, how many cells away).
template <typename Visit>
void GroundGrid::for_each_low(int cell, int reach, Visit&& visit) const {
  const Vector2f middle = middle_of(cell);
  for (int row = -reach; row <= reach; ++row) {
    for (int column = -reach; column <= reach; ++column) {
      const Vector3f& low = low_[static_cast<std::size_t>(cell + row * side_ + column)];
      if (low.z() == kUnseen) continue;
      visit(Vector3f(low.x() - middle.x(), low.y() - middle.y(), low.z()), std::max(std::abs(row), std::abs(column)));
    }
  }
}

/// A plane below which few of the lowest points are.
GroundGrid::Plane GroundGrid::slope_around(int cell) const {
  Plane plane{.z0 = kUnseen, .slope = Vector2f::Zero()};
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3f A = Eigen::Vector3f(0, kLevel, kLevel).asDiagonal();
    Vector3f b = Vector3f::Zero();
    for_each_low(cell, kSlopeAround, [&](const Vector3f& p, int) {
      const float weight = p.z() > plane.at(p.head<2>()) + kNear ? kAbove : 1.0F;
      const Vector3f row(1, p.x(), p.y());
      A += weight * row * row.transpose();
      b += weight * (p.z() - under_robot_) * row;
    });
    if (!(A(0, 0) > 0)) return {.z0 = under_robot_, .slope = Vector2f::Zero()};
    const Vector3f solved = A.ldlt().solve(b);
    plane = {.z0 = under_robot_ + solved.x(), .slope = solved.tail<2>()};
  }
  return plane;
}

GroundGrid::Plane GroundGrid::ground_of(int cell) const {
  Plane plane = slope_around(cell);
  float least = kUnseen;
  for_each_low(cell, kAround, [&](const Vector3f& p, int cells) {
    const auto away = static_cast<float>(std::max(cells, 1) - 1);
    least = std::min(least, p.z() - plane.at(p.head<2>()) + kUnsureSlope * away);
  });
  if (least == kUnseen) return {.z0 = under_robot_, .slope = Vector2f::Zero()};
  plane.z0 += least;
  return plane;
}

float GroundGrid::height(float x, float y) {
  const int cell = cell_of(x, y);
  if (cell < 0) return under_robot_;
  const auto i = static_cast<std::size_t>(cell);
  if (computed_[i] == 0) {
    ground_[i] = ground_of(cell);
    computed_[i] = 1;
  }
  return ground_[i].at(Vector2f(x, y) - middle_of(cell));
}

}  // namespace cairn::people
