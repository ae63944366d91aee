// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/furniture.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator::scenes {

using Eigen::Vector3d;

void desk(Mesh& mesh, const Placement& p) {
  mesh.box(p.at(0, 0, 0.71), 0.8, 1.6, 0.03, Material::kWood);
  mesh.box(p.at(0.36, 0, 0.3), 0.02, 1.4, 0.38, Material::kWood);
  for (const double side : {-0.76, 0.76}) mesh.box(p.at(0, side), 0.7, 0.04, 0.71, Material::kMetal);
  mesh.box(p.at(0.05, 0.5, 0.05), 0.6, 0.42, 0.55, Material::kMetal);
}

void office_chair(Mesh& mesh, const Placement& p) {
  for (int i = 0; i < 5; ++i) {
    const Placement leg{p.x, p.y, p.z, p.yaw + 2.0 * std::numbers::pi * i / 5.0};
    mesh.box(leg.at(0.16, 0, 0.04), 0.3, 0.05, 0.05, Material::kMetal);
  }
  mesh.cylinder(p.at(0, 0, 0.09), 0.03, 0.03, 0.36, 8, Material::kMetal);
  mesh.box(p.at(0, 0, 0.45), 0.48, 0.48, 0.08, Material::kFabric);
  mesh.frustum(p.at(-0.24, 0, 0.58), 0.07, 0.44, 0.05, 0.36, -0.08, 0.5, Material::kFabric);
}

void monitor(Mesh& mesh, const Placement& p) {
  mesh.box(p, 0.2, 0.25, 0.02, Material::kMetal);
  mesh.box(p.at(0.03, 0, 0.02), 0.04, 0.06, 0.15, Material::kMetal);
  mesh.box(p.at(0, 0, 0.14), 0.04, 0.56, 0.34, Material::kScreen);
}

void cabinet(Mesh& mesh, const Placement& p, double width, double height) {
  mesh.box(p.at(0, 0, 0.05), 0.45, width, height - 0.05, Material::kMetal);
  mesh.box(p.at(0.02, 0), 0.38, width - 0.04, 0.05, Material::kScreen);
}

void shelf(Mesh& mesh, const Placement& p, double width, double height) {
  for (const double side : {-0.5, 0.5}) mesh.box(p.at(0, side * (width - 0.03)), 0.35, 0.03, height, Material::kWood);
  mesh.box(p.at(0.165, 0), 0.01, width - 0.08, height - 0.01, Material::kWood);
  Random random(static_cast<std::uint64_t>(1000 * std::abs(p.x) + 77 * std::abs(p.y)), 5);
  for (double z = 0.06; z < height; z += 0.37) {
    mesh.box(p.at(0, 0, z), 0.32, width - 0.07, 0.025, Material::kWood);
    const double filled = random.uniform(0.2, 0.8) * (width - 0.1);
    const double books = random.uniform(0.18, 0.28);
    mesh.box(p.at(0.03, 0.5 * (width - 0.1 - filled), z + 0.026), 0.22, filled, books, Material::kFabric);
  }
}

void table(Mesh& mesh, const Placement& p, double length, double width) {
  mesh.box(p.at(0, 0, 0.7), length, width, 0.04, Material::kWood);
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      mesh.box(p.at(x * (length - 0.2), y * (width - 0.2)), 0.07, 0.07, 0.7, Material::kMetal);
    }
  }
}

void round_table(Mesh& mesh, const Placement& p, double radius, double height) {
  mesh.cylinder(p, 0.5 * radius, 0.4 * radius, 0.03, 16, Material::kMetal);
  mesh.cylinder(p.at(0, 0, 0.03), 0.05, 0.05, height - 0.06, 10, Material::kMetal);
  mesh.cylinder(p.at(0, 0, height - 0.03), radius, radius, 0.03, 24, Material::kWood);
}

void sofa(Mesh& mesh, const Placement& p, double width) {
  mesh.box(p.at(0, 0, 0.08), 0.85, width, 0.34, Material::kFabric);
  mesh.frustum(p.at(-0.33, 0, 0.42), 0.2, width, 0.14, width, -0.06, 0.42, Material::kFabric);
  for (const double side : {-0.5, 0.5}) {
    mesh.box(p.at(0.06, side * (width - 0.16), 0.42), 0.7, 0.16, 0.2, Material::kFabric);
  }
}

void radiator(Mesh& mesh, const Placement& p, double width) {
  mesh.box(p.at(0, 0, 0.12), 0.1, width, 0.6, Material::kPaint);
}

void plant(Mesh& mesh, const Placement& p, double height) {
  mesh.cylinder(p, 0.16, 0.22, 0.4, 12, Material::kConcrete);
  mesh.cylinder(p.at(0, 0, 0.39), 0.02, 0.015, 0.4 * height, 6, Material::kBark);
  const auto seed = static_cast<std::uint64_t>(1000 * std::abs(p.x) + 131 * std::abs(p.y));
  leaves(mesh, p.at(0, 0, 0.4 + 0.55 * (height - 0.4)), 0.38, 0.38, 0.45 * (height - 0.4), 130, 0.13, seed);
}

void bin(Mesh& mesh, const Placement& p) { mesh.cylinder(p, 0.13, 0.16, 0.38, 12, Material::kMetal); }

void lamp(Mesh& mesh, const Placement& p, double length, double width) {
  mesh.box(p.at(0, 0, -0.09), length, width, 0.06, Material::kPaint);
}

void leaves(Mesh& mesh, const Placement& centre, double half_x, double half_y, double half_z, int count, double size,
            std::uint64_t seed) {
  Random random(seed, 1);
  const auto in_ball = [&random] {
    for (;;) {
      const Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      if (p.squaredNorm() <= 1.0) return p;
    }
  };
  for (int i = 0; i < count; ++i) {
    const Vector3d p = centre * in_ball().cwiseProduct(Vector3d(half_x, half_y, half_z));
    const Vector3d u = size * in_ball().normalized(), v = size * in_ball().normalized();
    mesh.triangle(p, p + u, p + v, Material::kLeaves);
  }
}

}  // namespace cairn::simulator::scenes
