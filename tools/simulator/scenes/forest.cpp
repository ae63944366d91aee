// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/scenes.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kSize = 60.0;
constexpr double kCell = 0.5;  // of the ground mesh
constexpr double kPi = std::numbers::pi;

/// A hillside of 6 % with hollows and humps of several lengths. Smooth; steepest about 25 %.
double hillside(double x, double y) {
  return 2.0 + 0.055 * x + 0.025 * y + 0.55 * std::sin(0.26 * x + 0.4) * std::cos(0.21 * y) +
         0.28 * std::sin(0.47 * x - 0.33 * y + 1.0) + 0.06 * std::sin(1.15 * x + 0.3) * std::sin(1.05 * y + 2.0);
}

void ground_mesh(Mesh& m) {
  const auto corner = [](int i, int j) {
    const double x = i * kCell, y = j * kCell;
    return Eigen::Vector3d(x, y, hillside(x, y));
  };
  const int cells = static_cast<int>(kSize / kCell);
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      m.quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1), Material::kSoil);
    }
  }
}

Placement on_ground(double x, double y, double yaw, double up = 0) { return {x, y, hillside(x, y) + up, yaw}; }

/// A trunk in three slightly crooked pieces, and a crown of leaves with a few branches.
void tree(Mesh& m, double x, double y, std::uint64_t seed) {
  Random random(seed, 2);
  const double radius = random.uniform(0.09, 0.26), height = random.uniform(4.5, 9.0);
  Placement base = on_ground(x, y, random.uniform(0, 2 * kPi), -0.3);
  const double trunk = 0.75 * height;
  for (int piece = 0; piece < 3; ++piece) {
    const double r0 = radius * (1.0 - 0.25 * piece), r1 = radius * (0.75 - 0.25 * piece);
    m.cylinder(base, r0, r1, trunk / 3 + 0.3, 9, Material::kBark);
    base = base.at(random.uniform(-0.09, 0.09), random.uniform(-0.09, 0.09), trunk / 3);
  }
  const bool conifer = random.uniform() < 0.4;
  const double spread = random.uniform(0.9, 1.9);
  const double bottom = conifer ? 1.6 : 2.2;
  const int layers = conifer ? 5 : 3;
  for (int i = 0; i < layers; ++i) {
    const double up = bottom + (height - bottom) * (i + 0.5) / layers;
    const double half = conifer ? spread * (1.05 - 0.9 * i / layers) : spread * (i == 1 ? 1.0 : 0.75);
    const Placement centre = on_ground(x, y, 0, up).at(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    leaves(m, centre, half, half, 0.55 * (height - bottom) / layers, conifer ? 55 : 90, 0.2,
           mix(seed + 31u * static_cast<unsigned>(i)));
  }
}

void bush(Mesh& m, double x, double y, std::uint64_t seed) {
  Random random(seed, 3);
  const double half = random.uniform(0.3, 0.8), up = random.uniform(0.25, 0.6);
  leaves(m, on_ground(x, y, 0, up), half, half * random.uniform(0.7, 1.0), up, 110, 0.12, mix(seed));
}

void rock(Mesh& m, double x, double y, std::uint64_t seed) {
  Random random(seed, 4);
  const double size = random.uniform(0.35, 1.1);
  const Placement p = on_ground(x, y, random.uniform(0, kPi), -0.2);
  m.frustum(p, size, 0.8 * size, 0.6 * size, 0.5 * size, 0.1 * size, 0.2 + 0.5 * size, Material::kRock);
  m.frustum(p.at(0.3 * size, 0.2 * size, 0, 0.6), 0.7 * size, 0.7 * size, 0.4 * size, 0.4 * size, 0, 0.15 + 0.35 * size,
            Material::kRock);
}

/// Lies along the placement's y axis, following the ground at its ends.
void fallen_log(Mesh& m, double x, double y, double yaw, double length) {
  const double r = 0.2;
  const Placement middle = on_ground(x, y, yaw);
  const Placement left = middle.at(0, 0.5 * length), right = middle.at(0, -0.5 * length);
  const Eigen::Vector3d a(left.x, left.y, hillside(left.x, left.y) + 0.7 * r);
  const Eigen::Vector3d b(right.x, right.y, hillside(right.x, right.y) + 0.7 * r);
  const Eigen::Vector3d across = Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0) * r;
  const auto rim = [&](const Eigen::Vector3d& end, int i) -> Eigen::Vector3d {
    const double angle = 2 * kPi * (i % 8) / 8;
    return end + std::cos(angle) * across + Eigen::Vector3d(0, 0, std::sin(angle) * r);
  };
  for (int i = 0; i < 8; ++i) {
    m.quad(rim(a, i), rim(a, i + 1), rim(b, i + 1), rim(b, i), Material::kBark);
    m.triangle(a, rim(a, i), rim(a, i + 1), Material::kBark);
    m.triangle(b, rim(b, i), rim(b, i + 1), Material::kBark);
  }
}

/// A winding trail is kept clear of everything.
double distance_to_trail(double x, double y) { return std::abs(y - 30.0 - 9.0 * std::sin(0.16 * x)); }

/// Up to `count` random spots, none nearer than `apart` to another of them.
std::vector<Eigen::Vector2d> scatter(std::size_t count, double apart, double trail_margin, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector2d> spots;
  for (std::size_t tries = 0; tries < 60 * count && spots.size() < count; ++tries) {
    const Eigen::Vector2d p(random.uniform(0.8, kSize - 0.8), random.uniform(0.8, kSize - 0.8));
    if (distance_to_trail(p.x(), p.y()) < trail_margin) continue;
    bool free = true;
    for (const Eigen::Vector2d& other : spots) free = free && (p - other).norm() >= apart;
    if (free) spots.push_back(p);
  }
  return spots;
}

/// On the trail, and in clearings at least `clear` away from every trunk, bush and rock.
std::vector<Eigen::Vector2d> clearings(const std::vector<Eigen::Vector2d>& obstacles, double clear) {
  std::vector<Eigen::Vector2d> places;
  for (double x = 6; x < 55; x += 6) places.emplace_back(x, 30.0 + 9.0 * std::sin(0.16 * x));
  for (const Eigen::Vector2d& p : scatter(400, 5.0, 3.0, 77)) {
    if ((p.array() < 7.0).any() || (p.array() > kSize - 7.0).any()) continue;
    bool free = true;
    for (const Eigen::Vector2d& o : obstacles) free = free && (p - o).norm() >= clear;
    if (free) places.push_back(p);
  }
  return places;
}

}  // namespace

World forest() {
  World world;
  Mesh& m = world.mesh;
  ground_mesh(m);
  const auto trees = scatter(250, 2.3, 1.6, 11);
  const auto bushes = scatter(70, 3.5, 1.9, 12);
  const auto rocks = scatter(30, 5.0, 1.9, 13);
  std::uint64_t seed = 100;
  for (const Eigen::Vector2d& p : trees) tree(m, p.x(), p.y(), ++seed);
  for (const Eigen::Vector2d& p : bushes) bush(m, p.x(), p.y(), ++seed);
  for (const Eigen::Vector2d& p : rocks) rock(m, p.x(), p.y(), ++seed);
  fallen_log(m, 14.0, 46.5, 0.7, 4.5);
  fallen_log(m, 41.0, 39.5, 2.2, 5.5);
  fallen_log(m, 25.0, 12.0, 1.2, 4.0);
  std::vector<Eigen::Vector2d> obstacles = trees;
  obstacles.insert(obstacles.end(), bushes.begin(), bushes.end());
  obstacles.insert(obstacles.end(), rocks.begin(), rocks.end());
  world.inner_size = {kSize, kSize, m.bounds().sizes().z()};
  world.places = clearings(obstacles, 1.25);
  world.ground = hillside;
  world.open_air = true;
  return world;
}

}  // namespace cairn::simulator::scenes
