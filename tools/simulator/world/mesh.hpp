// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "tools/simulator/world/material.hpp"

namespace cairn::simulator {

/// Seen from both sides; single precision because that is what Embree takes.
struct Triangle {
  Eigen::Vector3f a, b, c;
  Material material;
};

/// Where a body stands: the centre of its base, and its heading in radians.
struct Placement {
  double x = 0, y = 0, z = 0, yaw = 0;

  /// A placement given in the frame of this one.
  [[nodiscard]] Placement at(double forward, double left, double up = 0, double turn = 0) const;
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p) const;
};

/// A soup of triangles and the bodies that worlds are made of. Metres.
class Mesh {
 public:
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, Material m);
  /// Corners in order around the face; planar.
  void quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d,
            Material m);
  /// `length` along x, `width` along y, `height` along z of the placement.
  void box(const Placement& base, double length, double width, double height, Material m);
  /// A frustum with four side faces: a box whose top rectangle is `top_length` × `top_width`, moved forward by `shift`.
  void frustum(const Placement& base, double length, double width, double top_length, double top_width, double shift,
               double height, Material m);
  /// A cone stump with radius `bottom` at the base and `top` above, closed at the top.
  void cylinder(const Placement& base, double bottom, double top, double height, int segments, Material m);
  /// A wheel: a cylinder lying along the placement's y axis, its centre at the placement.
  void wheel(const Placement& centre, double radius, double width, Material m);

  void translate(const Eigen::Vector3d& by);

  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  [[nodiscard]] Eigen::AlignedBox3d bounds() const;

 private:
  std::vector<Triangle> triangles_;
};

}  // namespace cairn::simulator
