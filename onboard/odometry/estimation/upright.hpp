// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/odometry/estimation/normal_equations.hpp"
#include "onboard/odometry/local_map/patch_map.hpp"

namespace cairn::odometry {

/// A plan of what stands upright near the robot: a grid of columns. A lookup takes a nanosecond.
/// Floors and ceilings are left out: they are everywhere.
class UprightColumns {
 public:
  /// Marks the columns of the map's finest grid around `centre` (in odom, metres) in which two
  /// blocks above each other hold points.
  void copy(const PatchMap& map, const Eigen::Vector3d& centre);
  /// Of these points (along the axes of odom, relative to the last copy's `centre`), how many lie
  /// in marked columns when all are moved by (dx, dy) metres.
  [[nodiscard]] int count(std::span<const Eigen::Vector2f> points, float dx, float dy) const;

 private:
  static constexpr int kWidth = 160, kHeight = 32;  // blocks: 80 m and 16 m with the default edge
  std::vector<std::uint8_t> blocks_, columns_;
  float per_metre_ = 1;
  Eigen::Vector2f offset_ = Eigen::Vector2f::Zero();  // of `centre` in the grid, in blocks
};

/// Chooses the points of a scan that stand upright: their column holds others above or
/// below, nearer than a ceiling is to its floor.
class UprightPoints {
 public:
  /// At most about `wanted` keypoints, evenly spread. `T_odom_lidar` tells up from down.
  void choose(std::span<const Keypoint> scan, const SE3& T_odom_lidar, std::size_t wanted, std::vector<Keypoint>& out);

 private:
  static constexpr int kWidth = 200, kBins = 64;  // columns of 0.5 m, bins of 0.3 m in each
  static constexpr float kBin_m = 0.3F;
  [[nodiscard]] static std::optional<std::size_t> column(const Eigen::Vector3f& p);
  [[nodiscard]] static std::optional<int> bin(const Eigen::Vector3f& p);
  [[nodiscard]] bool stands(const Eigen::Vector3f& p) const;

  std::vector<std::uint64_t> filled_;  // of each column, the bins that hold points
  std::vector<Keypoint> upright_;
};

}  // namespace cairn::odometry
