// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <vector>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/scenes.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLength = 20.0, kWidth = 5.0, kHeight = 3.0;
constexpr double kWall = 0.3, kDoor = 1.1, kHead = 2.1;

/// A thick wall along the hall with doors set back in it. `outward` is +1 where y grows out of the hall.
void side(Mesh& m, double inner_y, double outward, const std::vector<double>& doors) {
  const double y = inner_y + outward * 0.5 * kWall;
  std::vector<Opening> openings;
  for (const double at : doors) openings.push_back({at, kDoor, 0, kHead});
  wall(m, {{0, y}, {kLength, y}, kHeight, kWall}, openings);
  for (const double at : doors)
    m.box({at, inner_y + outward * 0.25, 0, 0}, kDoor - 0.02, 0.05, kHead - 0.01, Material::kDoor);
}

/// An end wall with a double door set back in it.
void end(Mesh& m, double inner_x, double outward, double door_at) {
  const double x = inner_x + outward * 0.5 * kWall;
  const Opening door{door_at, 1.8, 0, kHead};
  wall(m, {{x, 0}, {x, kWidth}, kHeight, kWall}, {&door, 1});
  m.box({inner_x + outward * 0.22, door_at, 0, 0}, 0.05, 1.78, kHead - 0.01, Material::kDoor);
}

void pillars(Mesh& m) {
  for (const double x : {5.1, 10.3, 15.5})
    for (const double y : {0.15, kWidth - 0.15}) m.box({x, y, 0, 0}, 0.4, 0.3, kHeight, Material::kConcrete);
}

void along_the_walls(Mesh& m) {
  radiator(m, {7.4, 0.13, 0, 0.5 * kPi}, 1.6);
  radiator(m, {13.1, kWidth - 0.13, 0, -0.5 * kPi}, 1.6);
  cabinet(m, {2.4, kWidth - 0.25, 0, 0.5 * kPi}, 1.6, 1.2);
  sofa(m, {17.1, 0.5, 0, 0.5 * kPi}, 1.8);
  plant(m, {19.4, 0.6, 0, 0}, 1.6);
  plant(m, {0.6, 0.6, 0, 0}, 1.9);
  bin(m, {11.0, 0.25, 0, 0});
  m.box({9.0, kWidth - 0.04, 1.0, 0}, 2.0, 0.06, 1.1, Material::kWood);    // notice board
  m.box({16.4, kWidth - 0.11, 0.9, 0}, 0.35, 0.2, 0.7, Material::kMetal);  // fire extinguisher's box
  m.box({12.2, 0.4, 0, 0}, 0.9, 0.75, 1.8, Material::kScreen);             // vending machine
}

}  // namespace

World hallway() {
  World world;
  Mesh& m = world.mesh;
  for (const double z : {0.0, kHeight})
    m.quad({-kWall, -kWall, z}, {kLength + kWall, -kWall, z}, {kLength + kWall, kWidth + kWall, z},
           {-kWall, kWidth + kWall, z}, z > 0 ? Material::kCeiling : Material::kStoneFloor);
  side(m, 0, -1, {3.2, 8.9, 14.2});
  side(m, kWidth, 1, {5.9, 11.6, 18.3});
  end(m, 0, -1, 2.7);
  end(m, kLength, 1, 2.1);
  pillars(m);
  along_the_walls(m);
  for (int i = 0; i < 5; ++i) lamp(m, {2.2 + 3.9 * i, 2.5, kHeight, 0}, 1.2, 0.3);
  world.inner_size = {kLength, kWidth, kHeight};
  world.places = {{1.6, 2.5},  {4.0, 1.9},  {6.5, 3.2},  {9.0, 2.3},  {11.2, 2.6},
                  {13.3, 3.1}, {15.4, 2.2}, {17.0, 2.6}, {18.4, 2.4}, {7.6, 2.0}};
  world.ground = [](double, double) { return 0.0; };
  return world;
}

}  // namespace cairn::simulator::scenes
