// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/missions/building.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::missions {
namespace {

using Eigen::Vector2d;
using simulator::Material;
using simulator::Mesh;
using simulator::Placement;
using simulator::Random;
namespace scenes = simulator::scenes;

constexpr double kHeight_m = 3, kDoor_m = 1.2;  // of the floor, and the width of a door

/// A room, its door side along its own x axis: x from 0 to width, y from 0 at the door wall to
/// depth.
struct Room {
  double width, depth, door;
  std::uint64_t furniture;
};

/// Against the walls, so that the middle stays free for a robot.
void furnish(Mesh& mesh, const Placement& corner, const Room& room) {
  Random random(room.furniture, 7);
  const auto pieces = 2 + random.below(4);
  for (std::size_t i = 0; i < pieces; ++i) {
    const double length = random.uniform(0.6, 2.0), depth = random.uniform(0.3, 0.8), height = random.uniform(0.5, 2.2);
    const bool back = random.uniform() < 0.5;
    const double along = random.uniform(0.2, 0.8);
    if (back)
      mesh.box(corner.at(0.3 + along * (room.width - 0.6), room.depth - 0.1 - 0.5 * depth), length * 0.7, depth, height,
               Material::kWood);
    else
      mesh.box(corner.at(i % 2 == 0 ? 0.1 + 0.5 * depth : room.width - 0.1 - 0.5 * depth,
                         0.3 * room.depth + 0.6 * along * room.depth, 0, 0.5 * std::numbers::pi),
               length, depth, height, Material::kWood);
  }
}

void build_room(Mesh& mesh, const Placement& corner, const Room& room) {
  const auto at = [&](double x, double y) {
    const Placement p = corner.at(x, y);
    return Vector2d(p.x, p.y);
  };
  const scenes::Opening door[] = {{room.door, kDoor_m}};
  scenes::wall(mesh, {at(0, 0), at(room.width, 0)}, door);
  scenes::wall(mesh, {at(0, 0), at(0, room.depth)});
  furnish(mesh, corner, room);
}

struct Plan {
  double length, width, corridor, from, to;  // the corridor lies between two y
  double cross, cross_width;                 // x and width of the one across
};

Plan draw_plan(Random& random) {
  Plan p{};
  p.length = random.uniform(32, 48);
  p.width = random.uniform(20, 30);
  p.corridor = random.uniform(2.0, 3.2);
  p.from = random.uniform(0.35, 0.55) * p.width;
  p.to = p.from + p.corridor;
  p.cross_width = random.uniform(1.8, 2.8);
  p.cross = random.uniform(0.3, 0.7) * p.length;
  return p;
}

Room draw_room(Random& random, double depth) {
  const double width = random.uniform(3.5, 8.5);
  return {width, depth, random.uniform(0.9, width - 0.9), random.next()};
}

/// Rooms from x = `from` to `to` on one side of the corridor; `up`: above it.
void row(simulator::World& world, const Plan& plan, double from, double to, bool up, Random& random,
         const Room* copied) {
  const double depth = up ? plan.width - plan.to : plan.from;
  for (double x = from; to - x > 2.5;) {
    Room room = copied != nullptr ? *copied : draw_room(random, depth);
    if (copied == nullptr && to - x - room.width < 2.5) room.width = to - x;
    if (room.width > to - x) room.width = to - x;
    room.door = std::min(room.door, room.width - 0.8);
    room.depth = std::min(room.depth, depth);
    // Below, the room is turned: its corner is at its right end.
    const Placement corner =
        up ? Placement{x, plan.to, 0, 0} : Placement{x + room.width, plan.from, 0, std::numbers::pi};
    build_room(world.mesh, corner, room);
    if (copied != nullptr && depth - room.depth > 0.3)
      scenes::wall(world.mesh, {Vector2d(corner.at(0, room.depth).x, corner.at(0, room.depth).y),
                                Vector2d(corner.at(room.width, room.depth).x, corner.at(room.width, room.depth).y)});
    for (const double along : {room.door, 0.5 * room.width}) {
      const Placement middle = corner.at(along, along == room.door ? 1.2 : 0.5 * room.depth);
      world.places.emplace_back(middle.x, middle.y);
    }
    x += room.width;
  }
  scenes::wall(world.mesh, {{to, up ? plan.to : 0.0}, {to, up ? plan.width : plan.from}});
}

/// What makes one place of a corridor differ from the next.
void clutter(Mesh& mesh, const Plan& plan, Random& random, int pieces) {
  for (int i = 0; i < pieces; ++i) {
    const double x = random.uniform(1, plan.length - 1), depth = random.uniform(0.15, 0.45);
    const bool up = random.uniform() < 0.5;
    mesh.box({x, up ? plan.to - 0.06 - 0.5 * depth : plan.from + 0.06 + 0.5 * depth, 0, 0}, random.uniform(0.4, 1.6),
             depth, random.uniform(0.6, 2.4), Material::kMetal);
  }
}

void shell(simulator::World& world, const Plan& plan) {
  const double l = plan.length, w = plan.width;
  world.mesh.quad({0, 0, 0}, {l, 0, 0}, {l, w, 0}, {0, w, 0}, Material::kCarpet);
  world.mesh.quad({0, 0, kHeight_m}, {l, 0, kHeight_m}, {l, w, kHeight_m}, {0, w, kHeight_m}, Material::kCeiling);
  const Vector2d corners[] = {{0, 0}, {l, 0}, {l, w}, {0, w}, {0, 0}};
  for (int i = 0; i < 4; ++i) scenes::wall(world.mesh, {corners[i], corners[i + 1]});
}

void corridor_places(simulator::World& world, const Plan& plan) {
  const double y = 0.5 * (plan.from + plan.to);
  for (double x = 1.5; x < plan.length - 1; x += 3) world.places.emplace_back(x, y);
  for (double v = 1.5; v < plan.width - 1; v += 3) world.places.emplace_back(plan.cross, v);
}

/// The half at low x, once more about the middle of the floor.
void turn_half(simulator::World& world, const Plan& plan) {
  const Mesh half = world.mesh;
  const auto turned = [&](const Eigen::Vector3f& p) {
    return Eigen::Vector3d(plan.length - static_cast<double>(p.x()), plan.width - static_cast<double>(p.y()),
                           static_cast<double>(p.z()));
  };
  for (const simulator::Triangle& t : half.triangles())
    world.mesh.triangle(turned(t.a), turned(t.b), turned(t.c), t.material);
  const auto places = world.places;
  for (const Vector2d& p : places) world.places.emplace_back(plan.length - p.x(), plan.width - p.y());
}

void fill(simulator::World& world, const Plan& plan, Copies copies, Random& random) {
  const double left = plan.cross - 0.5 * plan.cross_width, right = plan.cross + 0.5 * plan.cross_width;
  const double depth = std::min(plan.from, plan.width - plan.to);
  const Room copy = draw_room(random, depth);
  const Room* copied = copies == Copies::kRooms ? &copy : nullptr;
  for (const bool up : {false, true}) {
    if (copies == Copies::kHalfTurn) {
      row(world, plan, 0, left, up, random, nullptr);
    } else {
      row(world, plan, 0, left, up, random, copied);
      row(world, plan, right, plan.length, up, random, copied);
    }
  }
}

}  // namespace

simulator::World make_building(Copies copies, std::uint64_t seed) {
  Random random(seed, 4711);
  simulator::World world;
  Plan plan = draw_plan(random);
  if (copies == Copies::kHalfTurn) {
    plan.cross = 0.5 * plan.length;
    plan.from = 0.5 * (plan.width - plan.corridor);
    plan.to = plan.from + plan.corridor;
  }
  fill(world, plan, copies, random);
  if (copies == Copies::kHalfTurn) turn_half(world, plan);
  clutter(world.mesh, plan, random, copies == Copies::kNone ? 8 : 6);
  shell(world, plan);
  corridor_places(world, plan);
  world.name = copies == Copies::kNone ? "rooms" : copies == Copies::kRooms ? "copied" : "turned";
  world.inner_size = {plan.length, plan.width, kHeight_m};
  world.ground = [](double, double) { return 0.0; };
  world.bounds = world.mesh.bounds();
  return world;
}

}  // namespace cairn::missions
