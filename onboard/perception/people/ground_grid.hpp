// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace cairn::people {

/// How high the ground is around a robot, from one scan: the lowest points in cells of a metre, above or below a plane
/// that follows the slope around them. Where none was seen, the ground is as high as under the robot.
class GroundGrid {
 public:
  explicit GroundGrid(double farthest_m);

  /// Points in odom, metres; z is up. `sensor_odom`: where the LiDAR is; `sensor_height_m`: above the ground.
  void fill(std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom, float sensor_height_m);
  /// z of the ground at a place of odom. Remembers what it computes: one thread at a time.
  [[nodiscard]] float height(float x, float y);

 private:
  static constexpr float kCell = 1.0F;  // m
  /// z = z0 + slope · (x − middle of the cell, y − middle of the cell)
  struct Plane {
    float z0 = 0;
    Eigen::Vector2f slope = Eigen::Vector2f::Zero();
    [[nodiscard]] float at(const Eigen::Vector2f& from_middle) const { return z0 + slope.dot(from_middle); }
  };
  [[nodiscard]] int cell_of(float x, float y) const;
  [[nodiscard]] Eigen::Vector2f middle_of(int cell) const;
  [[nodiscard]] Plane ground_of(int cell) const;
  [[nodiscard]] Plane slope_around(int cell) const;
  template <typename Visit>
  void for_each_low(int cell, int reach, Visit&& visit) const;

  int side_;                            // cells
  std::vector<Eigen::Vector3f> low_;    // of each cell: its lowest point; z infinite: nothing seen
  std::vector<Plane> ground_;           // of each cell that was asked for
  std::vector<std::uint8_t> computed_;  // of each cell: whether ground_ is of this scan
  Eigen::Vector2f corner_ = Eigen::Vector2f::Zero();
  float under_robot_ = 0;
};

}  // namespace cairn::people
