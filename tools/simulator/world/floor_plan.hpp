// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// Outline of the robot around base_link (Clearpath Husky A200), and what it may run into.
struct Body {
  static constexpr double kLength = 0.99, kWidth = 0.67;              ///< m
  static constexpr double kWheelBase = 0.512, kTrack = 0.571;         ///< m, between the wheels' contact points
  static constexpr double kBaseHeight = 0.132;                        ///< of base_link above the ground
  static constexpr double kObstacleLow = 0.10, kObstacleHigh = 1.10;  ///< above the ground: what can be hit
};

/// What is between these heights above the ground, in metres, is an obstacle.
struct ObstacleBand {
  double low = Body::kObstacleLow, high = Body::kObstacleHigh;
};

/// The world as a robot on the ground sees it: cells of kCell metres and, for each, the distance to the nearest
/// obstacle or to the edge of the world.
class FloorPlan {
 public:
  static constexpr double kCell = 0.05;

  explicit FloorPlan(const World& world, const ObstacleBand& band = {});

  /// Distance to the nearest obstacle in metres, within a cell's diagonal; 0 in obstacles and outside of the world.
  [[nodiscard]] double clearance(const Eigen::Vector2d& p) const;
  /// The least clearance along the outline of the body at (x, y, yaw).
  [[nodiscard]] double body_clearance(double x, double y, double yaw) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i);
  }
  [[nodiscard]] double cell_clearance(std::size_t index) const { return static_cast<double>(clearance_[index]); }
  [[nodiscard]] Eigen::Vector2d centre(int i, int j) const {
    return origin_ + kCell * Eigen::Vector2d(i + 0.5, j + 0.5);
  }
  [[nodiscard]] Eigen::Vector2i cell(const Eigen::Vector2d& p) const;

 private:
  void mark(const World& world, const Triangle& triangle, std::vector<bool>& obstacle) const;
  void measure(const std::vector<bool>& obstacle);

  ObstacleBand band_;
  Eigen::Vector2d origin_;
  int width_ = 0, height_ = 0;
  std::vector<float> clearance_;
};

}  // namespace cairn::simulator
