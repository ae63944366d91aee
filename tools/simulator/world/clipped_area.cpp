// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/clipped_area.hpp"

#include <Eigen/Geometry>
#include <cstddef>

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

/// A convex facet; each clip adds one corner at most.
struct Facet {
  std::array<Vector3d, 9> corners;
  std::size_t size = 0;

  void add(const Vector3d& corner) { corners[size++] = corner; }
};

/// What of the facet has side · p[axis] ≤ half.
Facet cut(const Facet& whole, int axis, double side, double half) {
  Facet part;
  for (std::size_t i = 0; i < whole.size; ++i) {
    const Vector3d &a = whole.corners[i], &b = whole.corners[(i + 1) % whole.size];
    const double in_a = half - side * a[axis], in_b = half - side * b[axis];
    if (in_a >= 0) part.add(a);
    if ((in_a >= 0) != (in_b >= 0)) part.add(a + in_a / (in_a - in_b) * (b - a));
  }
  return part;
}

double area_of(const Facet& facet) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < facet.size; ++i)
    sum += (facet.corners[i] - facet.corners[0]).cross(facet.corners[i + 1] - facet.corners[0]);
  return 0.5 * sum.norm();
}

Facet cut(const std::array<Vector3d, 3>& corners, const Vector3d& centre, double half) {
  Facet facet;
  for (const Vector3d& corner : corners) facet.add(corner - centre);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) facet = cut(facet, axis, side, half);
  return facet;
}

}  // namespace

ClippedTriangle clip(const std::array<Vector3d, 3>& corners, const Vector3d& centre, double half) {
  const Facet facet = cut(corners, centre, half);
  ClippedTriangle clipped;
  for (std::size_t i = 1; i + 1 < facet.size; ++i) {
    const Vector3d &a = facet.corners[0], &b = facet.corners[i], &c = facet.corners[i + 1];
    clipped.pieces[clipped.size++] = {0.5 * (b - a).cross(c - a).norm(), centre + (a + b + c) / 3};
  }
  return clipped;
}

double clipped_area(const std::array<Vector3d, 3>& corners, const Vector3d& centre, double half) {
  return area_of(cut(corners, centre, half));
}

}  // namespace cairn::simulator
