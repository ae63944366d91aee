// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace cairn::simulator {

/// The part of a triangle that lies inside of a cube: convex, so it falls into triangles with a corner in common.
struct ClippedTriangle {
  struct Piece {
    double area;             ///< in the square of the corners' unit
    Eigen::Vector3d middle;  ///< its centroid
  };
  std::array<Piece, 7> pieces;
  std::size_t size = 0;  ///< pieces that there are
};

/// What of a triangle lies inside of a cube around `centre` with edges of 2 × `half`. The triangle is clipped at the
/// six faces, one after the other (Sutherland and Hodgman, 1974).
[[nodiscard]] ClippedTriangle clip(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& centre,
                                   double half);

/// The area alone.
[[nodiscard]] double clipped_area(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& centre,
                                  double half);

}  // namespace cairn::simulator
