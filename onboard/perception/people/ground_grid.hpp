// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cairn::people {

/// How high the ground is around a robot, from one scan: the lowest point in cells of a metre. Where none was seen, the
/// ground is as high as under the robot.
class GroundGrid {
 public:
  explicit GroundGrid(double farthest_m);

  /// Points in odom, metres; z is up. `sensor_odom`: where the LiDAR is; `sensor_height_m`: above the ground.
  void fill(std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom, float sensor_height_m);
  /// z of the ground at a place of odom: the lowest of the cells around it.
  [[nodiscard]] float height(float x, float y) const;

 private:
  static constexpr float kCell = 1.0F;  // m
  [[nodiscard]] int cell_of(float x, float y) const;

  int side_;                // cells
  std::vector<float> low_;  // of each cell; infinite: nothing seen
  Eigen::Vector2f corner_ = Eigen::Vector2f::Zero();
  float under_robot_ = 0;
};

}  // namespace cairn::people
