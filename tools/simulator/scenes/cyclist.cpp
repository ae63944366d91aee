// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulator/people/figure.hpp"
#include "tools/simulator/scenes/vehicles.hpp"

namespace cairn::simulator::scenes {
namespace {

using Eigen::Vector3d;

constexpr int kAround = 8, kRings = 4;  // of one capsule

Material of_rider(Material of_walker) {
  if (of_walker == Material::kSkin) return Material::kRiderSkin;
  return of_walker == Material::kClothesLight ? Material::kRiderClothes : Material::kRiderDark;
}

/// A point of the capsule's surface. Rings 0 and 1 are the half ball around `a`, 2 and 3 that around `b`.
Vector3d on_surface(const Capsule& c, const Vector3d& axis, int ring, int step) {
  constexpr std::array<double, kRings> kUp_deg{-40, 0, 0, 40};
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  const double up = kUp_deg[static_cast<std::size_t>(ring)] * std::numbers::pi / 180;
  const double around = 2 * std::numbers::pi * (step % kAround) / kAround;
  const Vector3d out = std::cos(up) * (std::cos(around) * u + std::sin(around) * v) + std::sin(up) * axis;
  return (ring < 2 ? c.a : c.b) + c.radius * out;
}

/// The same shape as a walker's part has, as triangles.
void capsule(Mesh& m, const Capsule& c) {
  const Material material = of_rider(c.material);
  const bool is_ball = (c.b - c.a).norm() < 1e-6;
  const Vector3d axis = is_ball ? Vector3d::UnitZ() : Vector3d((c.b - c.a).normalized());
  for (int step = 0; step < kAround; ++step) {
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      if (is_ball && ring == 1) continue;  // nothing lies between both halves
      const Vector3d low = on_surface(c, axis, ring, step), low_next = on_surface(c, axis, ring, step + 1);
      const Vector3d high = on_surface(c, axis, ring + 1, step), high_next = on_surface(c, axis, ring + 1, step + 1);
      m.quad(low, low_next, high_next, high, material);
    }
    m.triangle(on_surface(c, axis, 0, step), on_surface(c, axis, 0, step + 1), c.a - c.radius * axis, material);
    m.triangle(on_surface(c, axis, 3, step), on_surface(c, axis, 3, step + 1), c.b + c.radius * axis, material);
  }
}

}  // namespace

void cyclist(Mesh& m, const Placement& p) {
  bicycle(m, p);
  const Build build{.height = 1.78, .top = Material::kClothesLight, .trousers = Material::kClothesDark};
  const Figure figure = pose(build, p.at(0.12, 0), 0, 0);  // before the saddle
  for (const Capsule& part : figure.parts) capsule(m, part);
}

}  // namespace cairn::simulator::scenes
