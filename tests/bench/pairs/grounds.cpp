// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/pairs/grounds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/bench/missions/building.hpp"
#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/vehicles.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::pairs {
namespace {

using Eigen::Vector2d;
using simulator::Material;
using simulator::Mesh;
using simulator::Random;
using simulator::World;
namespace scenes = simulator::scenes;

constexpr std::uint64_t kHallStream = 51, kOpenStream = 52, kRoomStream = 53, kObjectStream = 54;

void shell(Mesh& mesh, double l, double w, double h) {
  const Vector2d corners[] = {{0, 0}, {l, 0}, {l, w}, {0, w}, {0, 0}};
  for (int i = 0; i < 4; ++i) scenes::wall(mesh, {.from = corners[i], .to = corners[i + 1], .height = h});
  mesh.quad({0, 0, 0}, {l, 0, 0}, {l, w, 0}, {0, w, 0}, Material::kCarpet);
  mesh.quad({0, 0, h}, {l, 0, h}, {l, w, h}, {0, w, h}, Material::kCeiling);
}

void finish(World& world, const char* name, const Eigen::Vector3d& size) {
  world.name = name;
  world.inner_size = size;
  if (!world.ground) world.ground = [](double, double) { return 0.0; };
  world.bounds = world.mesh.bounds();
}

/// Rows of seats on both sides of an aisle, the same on either side.
void seats(Mesh& mesh, double l, double w, double pitch) {
  for (double x = 0.3 * l; x < 0.8 * l; x += pitch)
    for (const double side : {-1.0, 1.0})
      mesh.box({x, 0.5 * w + side * (0.8 + 0.16 * w), 0, 0}, 0.5, 0.32 * w, 0.8, Material::kFabric);
}

/// What makes one side of a hall differ from the other.
void props(Mesh& mesh, double l, double w, Random& random) {
  const auto count = 5 + random.below(6);
  for (std::size_t i = 0; i < count; ++i) {
    const bool side = random.uniform() < 0.5, end = random.uniform() < 0.5;
    const double along = random.uniform(0.08, 0.92);
    mesh.box({along * l, side ? 0.6 : w - 0.6, 0, 0}, random.uniform(0.6, 2.5), random.uniform(0.4, 1),
             random.uniform(0.8, 3), Material::kWood);
    if (end) mesh.box({l - 0.5, along * w, 0, 0}, 0.7, random.uniform(0.6, 2), random.uniform(1, 3), Material::kMetal);
  }
}

/// Bays that three of four halls have on one side only: stairs, a gallery, a porch.
void bays(Mesh& mesh, double l, double w, double h, Random& random) {
  const bool far = random.uniform() < 0.5;
  for (double x = random.uniform(1, 4); x < l - 5;) {
    const double length = random.uniform(1.5, 5), depth = random.uniform(0.6, 1.3), high = random.uniform(1.5, h);
    mesh.box({x + 0.5 * length, far ? w - 0.5 * depth : 0.5 * depth, 0, 0}, length, depth, high, Material::kPlaster);
    x += length + random.uniform(1, 4);
  }
}

World hall(std::uint64_t seed) {
  Random random(seed, kHallStream);
  World world;
  const double l = random.uniform(24, 45), w = random.uniform(16, 30), h = random.uniform(5, 9);
  shell(world.mesh, l, w, h);
  const double bay = random.uniform(4, 7), inset = random.uniform(1.5, 3), thick = random.uniform(0.4, 0.8);
  for (double x = bay; x < l - 0.5 * bay; x += bay)
    for (const double y : {inset, w - inset}) world.mesh.box({x, y, 0, 0}, thick, thick, h, Material::kConcrete);
  if (seed % 4 != 0) bays(world.mesh, l, w, h, random);
  if (random.uniform() < 0.6) seats(world.mesh, l, w, random.uniform(1.4, 2.2));
  if (random.uniform() < 0.6)
    world.mesh.box({0.06 * l, 0.5 * w, 0, 0}, 0.1 * l, 0.6 * w, random.uniform(0.5, 1.1), Material::kWood);
  props(world.mesh, l, w, random);
  for (double x = 2; x < l - 1.5; x += 3)
    for (const double y : {inset + 1.2, 0.5 * w, w - inset - 1.2}) world.places.emplace_back(x, y);
  finish(world, "hall", {l, w, h});
  return world;
}

void house(Mesh& mesh, const simulator::Placement& at, Random& random) {
  const double l = random.uniform(8, 18), w = random.uniform(6, 12), h = random.uniform(4, 9);
  mesh.box(at, l, w, h, Material::kConcrete);
  if (random.uniform() < 0.7)
    mesh.box(at.at(0.5 * l + random.uniform(0.5, 2), random.uniform(-0.3, 0.3) * w), random.uniform(2, 4),
             random.uniform(2, 5), random.uniform(2.5, 4), Material::kPlaster);
  if (random.uniform() < 0.5) mesh.frustum(at.at(0, 0, h), l, w, l, 0.2, 0, random.uniform(1, 3), Material::kWood);
}

void plant(World& world, const Vector2d& at, Random& random) {
  const double radius = random.uniform(0.12, 0.4), trunk = random.uniform(1.5, 3.5);
  const double z = world.ground(at.x(), at.y()) - 0.3;
  world.mesh.cylinder({at.x(), at.y(), z, 0}, radius, radius, trunk + 0.3, 10, Material::kWood);
  if (random.uniform() < 0.7)
    world.mesh.cylinder({at.x(), at.y(), z + trunk, 0}, random.uniform(0.8, 2), 0.2, random.uniform(2, 4), 10,
                        Material::kFabric);
}

/// Rolling ground, as triangles of 4 m.
void roll(World& world, double edge, Random& random) {
  const double height = random.uniform(0.1, 0.9), length = random.uniform(14, 30), phase = random.uniform(0, 6);
  world.ground = [=](double x, double y) {
    return height * (std::sin(x / length + phase) + std::sin(0.8 * y / length + 0.3 * x / length));
  };
  const auto at = [&](double x, double y) { return Eigen::Vector3d(x, y, world.ground(x, y)); };
  constexpr double kStep = 4;
  for (double x = -20; x < edge + 20; x += kStep)
    for (double y = -20; y < edge + 20; y += kStep)
      for (const bool upper : {false, true})
        world.mesh.triangle(at(x, y), upper ? at(x, y + kStep) : at(x + kStep, y), at(x + kStep, y + kStep),
                            Material::kAsphalt);
}

World open_air(std::uint64_t seed, double edge) {
  Random random(seed, kOpenStream);
  World world;
  roll(world, edge, random);
  const double block = random.uniform(24, 32);
  for (double x = 0.5 * block; x < edge; x += block)
    for (double y = 0.5 * block; y < edge; y += block) {
      const Vector2d at(x + random.uniform(-3, 3), y + random.uniform(-3, 3));
      if (random.uniform() < 0.75)
        house(world.mesh, {at.x(), at.y(), world.ground(at.x(), at.y()) - 1, random.uniform(-0.4, 0.4)}, random);
      for (auto n = 2 + random.below(5); n > 0; --n)
        plant(world, {x + random.uniform(-0.42, 0.42) * block, y + random.uniform(-0.42, 0.42) * block}, random);
      const double left = x - 0.5 * block + 2.8, along = y + random.uniform(-0.4, 0.4) * block;
      scenes::car(world.mesh, {left, along, world.ground(left, along), 0.5 * std::numbers::pi},
                  static_cast<scenes::CarKind>(random.below(3)), Material::kMetal);
    }
  for (double x = 0; x <= edge; x += block)
    for (double y = 0; y <= edge; y += block)
      for (const double part : {0.0, 0.35, 0.7}) {
        world.places.emplace_back(x + part * block, y);
        if (part > 0) world.places.emplace_back(x, y + part * block);
      }
  world.open_air = true;
  finish(world, edge > 100 ? "town" : "outdoor", {edge, edge, 12});
  return world;
}

}  // namespace

World make_ground(Kind kind, std::uint64_t seed) {
  constexpr double kOutdoor_m = 80, kTown_m = 400;
  switch (kind) {
    case Kind::kRooms:
      return missions::make_building(missions::Copies::kNone, seed);
    case Kind::kHall:
      return hall(seed);
    case Kind::kOutdoor:
      return open_air(seed, kOutdoor_m);
    case Kind::kTown:
      return open_air(seed, kTown_m);
  }
  return {};
}

World make_room(std::uint64_t room, std::uint64_t outside) {
  Random random(room, kRoomStream), beyond(outside, kRoomStream + 1);
  World world;
  const double l = random.uniform(4, 7), w = random.uniform(3.5, 6), door = random.uniform(0.8, l - 0.8), wide = 10;
  Mesh& mesh = world.mesh;
  const scenes::Opening opening[] = {{.at = door, .width = 1}};
  scenes::wall(mesh, {.from = {0, 0}, .to = {l, 0}}, opening);
  scenes::wall(mesh, {.from = {l, 0}, .to = {l, w}});
  scenes::wall(mesh, {.from = {l, w}, .to = {0, w}});
  scenes::wall(mesh, {.from = {0, w}, .to = {0, 0}});
  scenes::desk(mesh, {0.9, w - 1.2, 0, random.uniform(0, 3)});
  scenes::cabinet(mesh, {l - 0.4, random.uniform(1, w - 1), 0, 0}, 1.2, random.uniform(1, 2));
  scenes::shelf(mesh, {random.uniform(1.5, l - 1.5), w - 0.3, 0, 0.5 * std::numbers::pi}, 1.4, 1.9);
  scenes::table(mesh, {0.5 * l, 0.5 * w, 0, random.uniform(0, 3)}, 1.4, 0.8);
  const double far = -beyond.uniform(1.6, 3);
  scenes::wall(mesh, {.from = {door - wide, far}, .to = {door + wide, far}});
  for (int i = 0; i < 5; ++i)
    mesh.box({door + beyond.uniform(-4, 4), far + 0.3, 0, 0}, beyond.uniform(0.4, 1.5), 0.4, beyond.uniform(0.5, 2.4),
             Material::kWood);
  for (const double z : {0.0, 3.0})
    mesh.quad({door - wide, far, z}, {door + wide, far, z}, {door + wide, w, z}, {door - wide, w, z},
              Material::kCarpet);
  world.places = {{0.3 * l, 0.3 * w}, {0.7 * l, 0.3 * w}, {0.25 * l, 0.7 * w}, {0.75 * l, 0.75 * w}, {door, 0.6}};
  finish(world, "room", {l, w, 3});
  return world;
}

void add_objects(World& world, int count, double size_m, std::uint64_t seed) {
  Random random(seed, kObjectStream);
  for (int i = 0; i < count && !world.places.empty(); ++i) {
    const Vector2d place = world.places[random.below(world.places.size())];
    const double turn = random.uniform(0, 2 * std::numbers::pi), off = random.uniform(1.0, 1.8) + 0.4 * size_m;
    const Vector2d at = place + off * Vector2d(std::cos(turn), std::sin(turn));
    world.mesh.box({at.x(), at.y(), world.ground(at.x(), at.y()), turn}, size_m * random.uniform(0.8, 1.2),
                   size_m * random.uniform(0.8, 1.2), size_m * random.uniform(0.8, 1.2), Material::kWood);
  }
}

}  // namespace cairn::pairs
