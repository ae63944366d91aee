// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/street_furniture.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

/// A disc of `radius` that faces −x of its centre.
void disc(Mesh& m, const Placement& centre, double radius, Material material) {
  constexpr int kSegments = 16;
  const auto rim = [&](int i) {
    const double a = 2 * kPi * (i % kSegments) / kSegments;
    return centre * Eigen::Vector3d(0, radius * std::cos(a), radius * std::sin(a));
  };
  for (int i = 0; i < kSegments; ++i) m.triangle(centre * Eigen::Vector3d(0, 0, 0), rim(i), rim(i + 1), material);
}

/// A pane in the façade, `out` in front of it, with a frame around.
void window(Mesh& m, const Placement& front, double left, double sill, double width, double height) {
  const auto at = [&](double y, double z) { return front * Eigen::Vector3d(-0.03, left + y, sill + z); };
  m.quad(at(-width / 2, 0), at(width / 2, 0), at(width / 2, height), at(-width / 2, height), Material::kWindow);
  for (const double z : {-0.06, height}) {
    m.box(front.at(-0.05, left, sill + z), 0.1, width + 0.16, 0.06, Material::kRender);
  }
  m.box(front.at(-0.05, left, sill), 0.06, 0.06, height, Material::kRender);
}

}  // namespace

void street_lamp(Mesh& m, const Placement& p) {
  m.cylinder(p, 0.09, 0.06, 6.0, 10, Material::kPole);
  m.box(p.at(-0.6, 0, 5.9), 1.3, 0.07, 0.07, Material::kPole);
  m.box(p.at(-1.2, 0, 5.82), 0.6, 0.25, 0.1, Material::kPole);
}

void traffic_sign(Mesh& m, const Placement& p) {
  m.cylinder(p, 0.035, 0.035, 2.6, 8, Material::kPole);
  disc(m, p.at(-0.045, 0, 2.3), 0.32, Material::kRetroreflector);
  m.box(p.at(-0.045, 0, 1.65), 0.01, 0.5, 0.25, Material::kRetroreflector);
}

void traffic_light(Mesh& m, const Placement& p) {
  m.cylinder(p, 0.07, 0.06, 3.3, 10, Material::kPole);
  m.box(p.at(-0.18, 0, 2.35), 0.22, 0.32, 0.95, Material::kTrafficLight);
  for (const double up : {2.5, 2.82, 3.14}) m.box(p.at(-0.36, 0, up + 0.1), 0.16, 0.24, 0.02, Material::kTrafficLight);
  m.box(p.at(0, 0.18, 2.1), 0.2, 0.22, 0.6, Material::kTrafficLight);  // for those on foot
}

void street_tree(Mesh& m, const Placement& p, std::uint64_t seed) {
  Random random(seed, 6);
  const double trunk = random.uniform(2.3, 2.9), radius = random.uniform(0.13, 0.2), spread = random.uniform(1.5, 2.1);
  m.cylinder(p.at(0, 0, -0.1), radius, 0.7 * radius, trunk + 1.0, 10, Material::kBark);
  for (int i = 0; i < 5; ++i) {
    const double up = trunk + 0.5 + 0.62 * i, half = spread * (i < 3 ? 0.8 + 0.1 * i : 0.75 - 0.2 * (i - 3));
    const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.3, 0.3);
    leaves(m, p.at(x, y, up), half, half, 0.75, 330, 0.3, mix(seed + static_cast<unsigned>(i)));
  }
}

void hedge(Mesh& m, const Placement& p, double length, double height, std::uint64_t seed) {
  m.box(p, length, 0.5, height - 0.1, Material::kLeaves);
  for (double x = -0.5 * length + 0.5; x < 0.5 * length; x += 1.0) {
    leaves(m, p.at(x, 0, 0.5 * height), 0.6, 0.42, 0.55 * height, 120, 0.14,
           mix(seed + static_cast<unsigned>(10 * (x + 60))));
  }
}

void picket_fence(Mesh& m, const Placement& from, double length) {
  constexpr double kHeight = 1.15;
  for (const double up : {0.25, 0.9}) m.box(from.at(0.5 * length, 0, up), length, 0.03, 0.07, Material::kFence);
  for (double x = 0; x <= length; x += 0.14)
    m.box(from.at(x, 0.025, 0.06), 0.07, 0.02, kHeight - 0.06, Material::kFence);
  for (double x = 0; x <= length; x += 2.24) m.box(from.at(x, -0.05), 0.09, 0.09, kHeight + 0.1, Material::kFence);
}

void bench(Mesh& m, const Placement& p) {
  for (const double y : {-0.7, 0.7}) m.box(p.at(0, y), 0.45, 0.06, 0.42, Material::kMetal);
  m.box(p.at(0, 0, 0.42), 0.45, 1.7, 0.05, Material::kWood);
  m.box(p.at(0.24, 0, 0.55), 0.04, 1.7, 0.35, Material::kWood);
}

void house(Mesh& m, const House& h) {
  m.box(h.front.at(0.5 * h.depth, 0), h.depth, h.width, h.height, h.walls);
  const double storey = h.height / h.storeys;
  const int bays = static_cast<int>(h.width / h.bay);
  for (int i = 0; i < bays; ++i) {
    const double left = (i - 0.5 * (bays - 1)) * h.bay;
    for (int level = 0; level < h.storeys; ++level) {
      if (level == 0 && i == bays / 2) continue;  // the door
      window(m, h.front, left, level * storey + 0.95, 0.48 * h.bay, 0.52 * storey);
    }
    if (i != bays / 2) continue;
    m.box(h.front.at(-0.02, left), 0.06, 1.1, 2.1, Material::kDoor);
    m.box(h.front.at(-0.35, left, 2.35), 0.7, 1.6, 0.1, Material::kConcrete);
  }
  m.box(h.front.at(-0.06, 0), 0.06, h.width, 0.35, Material::kConcrete);  // plinth
  m.frustum(h.front.at(0.5 * h.depth, 0, h.height), h.depth + 0.8, h.width, 1.0, h.width, 0, 2.2, Material::kRoofTile);
}

}  // namespace cairn::simulator::scenes
