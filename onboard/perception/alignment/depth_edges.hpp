// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/point_cloud.hpp"
#include "hal/se3.hpp"

namespace cairn::alignment {

/// How an edge lies in a picture.
enum class EdgeKind : std::uint8_t {
  kUpright,  ///< as the side of a pole: the neighbour across it is to the left or right
  kLevel,    ///< as the top of a wall: the neighbour across it is above or below
};

/// A place where the range jumps between two neighbours of a scan. The rim of the nearer thing lies somewhere between
/// their two rays, which may be far apart: lasers above each other often are.
struct DepthEdge {
  Eigen::Vector3f inside_base;   ///< the nearer neighbour, metres
  Eigen::Vector3f outside_base;  ///< at its range on the ray of the farther one
  EdgeKind kind = EdgeKind::kUpright;
};

/// Finds the edges of a scan. Neighbours side by side are those of one laser; where a cloud does not number its lasers,
/// its points come laser by laser, as KITTI's do. Neighbours above each other lie in the same narrow sector. An edge is
/// a jump of the inverse range that is far larger than the changes on both sides of it: on planes, ground and slanting
/// walls too, the inverse range changes evenly.
class DepthEdgeFinder {
 public:
  /// `cloud`: in the sensor's frame; `points_base`: the same points in the same order, deskewed, in base_link.
  /// `R_base_sensor`: of the mount. Replaces the edges of the last call; valid until the next one. None if the sizes
  /// differ.
  std::span<const DepthEdge> find(const PointCloud& cloud, std::span<const Eigen::Vector3f> points_base,
                                  const Eigen::Matrix3d& R_base_sensor);

 private:
  /// A point as the sensor sees it.
  struct Ray {
    std::uint32_t index = 0;           ///< in the cloud
    float azimuth = 0, elevation = 0;  ///< rad
    float inverse = 0;                 ///< 1 / range, 1/m
  };
  void sort_side_by_side(const PointCloud& cloud);
  void sort_above_each_other();
  [[nodiscard]] float usual_step() const;
  void scan_rows(EdgeKind kind, float longest_step, const PointCloud& cloud, std::span<const Eigen::Vector3f> points,
                 const Eigen::Matrix3d& R_base_sensor);

  std::vector<Ray> rays_;            // in the cloud's order, then in that of the rows
  std::vector<std::uint32_t> rows_;  // where each row of neighbours begins in rays_
  std::vector<DepthEdge> edges_;
};

}  // namespace cairn::alignment
