// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/mesh.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace cairn::simulator {

using Eigen::Vector3d;

Placement Placement::at(double forward, double left, double up, double turn) const {
  const Vector3d p = *this * Vector3d(forward, left, up);
  return {p.x(), p.y(), p.z(), yaw + turn};
}

Vector3d Placement::operator*(const Vector3d& p) const {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {x + c * p.x() - s * p.y(), y + s * p.x() + c * p.y(), z + p.z()};
}

void Mesh::triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, Material m) {
  triangles_.push_back({a.cast<float>(), b.cast<float>(), c.cast<float>(), m});
}

void Mesh::quad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, Material m) {
  triangle(a, b, c, m);
  triangle(a, c, d, m);
}

void Mesh::box(const Placement& base, double length, double width, double height, Material m) {
  frustum(base, length, width, length, width, 0.0, height, m);
}

void Mesh::frustum(const Placement& base, double length, double width, double top_length, double top_width,
                   double shift, double height, Material m) {
  constexpr std::array<std::array<double, 2>, 4> kCorners{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  std::array<Vector3d, 4> low, high;
  for (std::size_t i = 0; i < 4; ++i) {
    low[i] = base * Vector3d(kCorners[i][0] * length, kCorners[i][1] * width, 0);
    high[i] = base * Vector3d(kCorners[i][0] * top_length + shift, kCorners[i][1] * top_width, height);
  }
  quad(low[0], low[1], low[2], low[3], m);
  quad(high[0], high[1], high[2], high[3], m);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    quad(low[i], low[j], high[j], high[i], m);
  }
}

void Mesh::cylinder(const Placement& base, double bottom, double top, double height, int segments, Material m) {
  const double step = 2.0 * std::numbers::pi / segments;
  for (int i = 0; i < segments; ++i) {
    const double c0 = std::cos(i * step), s0 = std::sin(i * step);
    const double c1 = std::cos((i + 1) % segments * step), s1 = std::sin((i + 1) % segments * step);
    const Vector3d a = base * Vector3d(bottom * c0, bottom * s0, 0), b = base * Vector3d(bottom * c1, bottom * s1, 0);
    const Vector3d c = base * Vector3d(top * c1, top * s1, height), d = base * Vector3d(top * c0, top * s0, height);
    quad(a, b, c, d, m);
    triangle(d, c, base * Vector3d(0, 0, height), m);
  }
}

void Mesh::wheel(const Placement& centre, double radius, double width, Material m) {
  constexpr int kSegments = 14;
  const double step = 2.0 * std::numbers::pi / kSegments;
  const auto rim = [&](int i, double side) {
    const double angle = i % kSegments * step;
    return centre * Vector3d(radius * std::cos(angle), side, radius * std::sin(angle));
  };
  for (int i = 0; i < kSegments; ++i) {
    quad(rim(i, -width / 2), rim(i + 1, -width / 2), rim(i + 1, width / 2), rim(i, width / 2), m);
    for (const double side : {-width / 2, width / 2}) {
      triangle(rim(i, side), rim(i + 1, side), centre * Vector3d(0, side, 0), m);
    }
  }
}

void Mesh::translate(const Vector3d& by) {
  const Eigen::Vector3f t = by.cast<float>();
  for (Triangle& tri : triangles_) {
    tri.a += t;
    tri.b += t;
    tri.c += t;
  }
}

Eigen::AlignedBox3d Mesh::bounds() const {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : triangles_) {
    box.extend(t.a.cast<double>()).extend(t.b.cast<double>()).extend(t.c.cast<double>());
  }
  return box;
}

}  // namespace cairn::simulator
