// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "onboard/client/view/planner_view.hpp"

namespace cairn::client {

/// Distance in metres from each cell's centre to the nearest marked cell's, on a grid of `width`·`height` cells, x
/// fastest. Infinite where no cell is marked. Exact: Felzenszwalb, Huttenlocher, "Distance transforms of sampled
/// functions", 2012.
[[nodiscard]] std::vector<float> distances_2d(std::span<const std::uint8_t> marked, int width, int height,
                                              double cell_m);

/// A block around the robot, and how far each of its voxels is from the nearest occupied one in the block.
struct DistanceField {
  /// How large the block is.
  struct Extent {
    double side_m = 8, up_m = 2, down_m = 1;  ///< half the horizontal edge; above and below base_link
  };
  double resolution_m = 0;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();    ///< voxels
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< lowest, in odom, m
  std::vector<float> distance_m;                     ///< x fastest, then y

  /// At a point of odom. Infinite outside of the block, and where the block holds nothing occupied. What nobody has
  /// seen counts as free: ask the view.
  [[nodiscard]] float at(const Eigen::Vector3d& p_odom) const;
};

/// The field around `T_odom_base`. At most 16 million voxels: larger extents are cut.
[[nodiscard]] DistanceField make_distance_field(const PlannerView& view, const SE3& T_odom_base,
                                                const DistanceField::Extent& extent = {});

}  // namespace cairn::client
