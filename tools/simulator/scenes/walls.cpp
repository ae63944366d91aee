// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tools/simulator/scenes/furniture.hpp"

namespace cairn::simulator::scenes {
namespace {

/// The part of a wall between `from` and `to` along it, and between two heights.
void piece(Mesh& mesh, const Wall& w, double from, double to, double low, double high) {
  if (to - from < 1e-6 || high - low < 1e-6) return;
  mesh.box(on_wall(w, 0.5 * (from + to), low), to - from, w.thickness, high - low, w.material);
}

}  // namespace

Placement on_wall(const Wall& w, double along, double up) {
  const Eigen::Vector2d direction = (w.to - w.from).normalized();
  const Eigen::Vector2d p = w.from + along * direction;
  return {p.x(), p.y(), up, std::atan2(direction.y(), direction.x())};
}

void wall(Mesh& mesh, const Wall& w, std::span<const Opening> openings) {
  double done = 0;
  for (const Opening& o : openings) {
    const double left = o.at - 0.5 * o.width, right = o.at + 0.5 * o.width;
    piece(mesh, w, done, left, 0, w.height);
    piece(mesh, w, left, right, 0, o.sill);
    piece(mesh, w, left, right, o.head, w.height);
    done = right;
  }
  piece(mesh, w, done, (w.to - w.from).norm(), 0, w.height);
}

void door_frame(Mesh& mesh, const Placement& at, double width, double head, double thickness) {
  const double depth = thickness + 0.06;
  for (const double side : {-0.5, 0.5}) {
    mesh.box(at.at(side * (width - 0.05) + std::copysign(0.005, side), 0), 0.05, depth, head, Material::kDoorFrame);
  }
  mesh.box(at.at(0, 0, head - 0.05), width - 0.08, depth - 0.01, 0.06, Material::kDoorFrame);
}

void door_leaf(Mesh& mesh, const Placement& at, double width, double head, bool hinge_right, double angle) {
  const double side = hinge_right ? 1.0 : -1.0;
  const double leaf = width - 0.11;
  const Placement hinge = at.at(side * 0.5 * leaf, 0, 0.01, -side * angle);
  mesh.box(hinge.at(-side * 0.5 * leaf, 0), leaf, 0.04, head - 0.07, Material::kDoor);
  mesh.box(hinge.at(-side * (leaf - 0.08), 0, 1.02), 0.12, 0.14, 0.02, Material::kMetal);
}

}  // namespace cairn::simulator::scenes
