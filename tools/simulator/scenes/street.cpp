// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/scenes.hpp"
#include "tools/simulator/scenes/street_furniture.hpp"
#include "tools/simulator/scenes/vehicles.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kPi = std::numbers::pi;
// From south to north: houses, pavement, road, pavement, campus green, campus building. Houses close both ends.
constexpr double kLength = 80.0, kWidth = 56.0, kWest = 4.0, kEast = 76.0;
constexpr double kSouthFront = 10.0, kRoadSouth = 13.5, kRoadNorth = 21.0, kGreen = 24.5, kNorthFront = 46.0;
constexpr double kPavement = 0.06, kKerb = 0.2;  // height of the pavements; half the width of the lowered kerb

/// The road lies lower; kerbs are lowered everywhere, as in front of drives.
double level(double, double y) {
  const double depth = std::min(y - kRoadSouth, kRoadNorth - y);
  const double u = std::clamp((depth + kKerb) / (2 * kKerb), 0.0, 1.0);
  return kPavement * (1.0 - u * u * (3.0 - 2.0 * u));
}

/// A strip of ground along the whole street.
void strip(Mesh& m, double y0, double y1, Material material) {
  m.quad({kWest, y0, level(0, y0)}, {kEast, y0, level(0, y0)}, {kEast, y1, level(0, y1)}, {kWest, y1, level(0, y1)},
         material);
}

/// Paint and paths lie a little above what they are on.
void patch(Mesh& m, double x0, double y0, double x1, double y1, Material material) {
  constexpr double kAbove = 0.004;
  const double z = level(0, 0.5 * (y0 + y1)) + kAbove;
  m.quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}, material);
}

void ground(Mesh& m) {
  strip(m, kSouthFront, kRoadSouth - kKerb, Material::kPavement);
  strip(m, kRoadSouth + kKerb, kRoadNorth - kKerb, Material::kAsphalt);
  strip(m, kRoadNorth + kKerb, kGreen, Material::kPavement);
  strip(m, kGreen, kNorthFront, Material::kGrass);
  for (int i = 0; i < 4; ++i) {
    const double a = -kKerb + 0.5 * kKerb * i, b = a + 0.5 * kKerb;
    strip(m, kRoadSouth + a, kRoadSouth + b, Material::kKerb);
    strip(m, kRoadNorth + a, kRoadNorth + b, Material::kKerb);
  }
  const double middle = 0.5 * (kRoadSouth + kRoadNorth) + 1.1;  // cars are parked along the south side
  for (double x = kWest + 1; x < kEast - 2; x += 3.0) {
    if (std::abs(x - 41) > 4) patch(m, x, middle - 0.06, x + 1.6, middle + 0.06, Material::kRoadPaint);
  }
  for (double y = kRoadSouth + 0.6; y < kRoadNorth - 0.6; y += 1.0)
    patch(m, 39.5, y, 42.5, y + 0.5, Material::kRoadPaint);
  for (const double x : {14.0, 41.0, 66.0}) patch(m, x - 1.4, kGreen, x + 1.4, kNorthFront, Material::kPavement);
  patch(m, kWest, 34.0, kEast, 36.6, Material::kPavement);
}

void houses(Mesh& m) {
  const Material walls[] = {Material::kBrick,    Material::kRender, Material::kBrick,
                            Material::kConcrete, Material::kRender, Material::kBrick};
  for (int i = 0; i < 6; ++i) {
    const double height = 7.6 + 0.6 * (i * 5 % 4);
    house(m, {{kWest + 6.0 + 12.0 * i, kSouthFront, 0, -0.5 * kPi}, 12, 9.0, height, walls[i], 3, 2.4});
  }
  house(m, {{0.5 * kLength, kNorthFront, 0, 0.5 * kPi}, kEast - kWest, 9.0, 9.0, Material::kBrick, 3, 3.0});
  house(m, {{kWest, 0.5 * kWidth, 0, kPi}, kNorthFront - kSouthFront, 3.2, 8.0, Material::kRender, 3, 3.0});
  house(m, {{kEast, 0.5 * kWidth, 0, 0}, kNorthFront - kSouthFront, 3.2, 8.4, Material::kBrick, 3, 2.8});
}

void parked(Mesh& m) {
  Random random(0x57ee7);
  const Material paints[] = {Material::kCarPaintLight, Material::kCarPaintDark};
  for (double x = 9; x < 72; x += 6.2) {
    const bool taken = random.uniform() < 0.75;
    const auto kind = static_cast<CarKind>(random.below(3));
    const Material paint = paints[random.below(2)];
    const double heading = random.uniform() < 0.85 ? 0.0 : kPi;
    if (taken && std::abs(x - 41) > 4.5) car(m, {x, kRoadSouth + 1.35, 0, heading}, kind, paint);
  }
  bus(m, {61.0, kRoadNorth - 1.6, 0, kPi});
  truck(m, {24.0, kRoadNorth - 1.5, 0, kPi});
  motorcycle(m, {34.5, kRoadNorth - 0.8, 0, kPi + 0.2});
  motorcycle(m, {33.2, kRoadNorth - 0.8, 0, kPi + 0.15});
  for (int i = 0; i < 6; ++i) bicycle(m, {46.0 + 0.75 * i, 43.8, kPavement, 0.5 * kPi + 0.06 * (i % 3)});
  for (int i = 0; i < 4; ++i) bicycle(m, {29.0 + 0.8 * i, kSouthFront + 1.0, kPavement, -0.5 * kPi + 0.05 * (i % 3)});
}

void along_the_road(Mesh& m) {
  for (const double x : {12.0, 30.0, 50.0, 70.0}) {
    street_lamp(m, {x, kRoadNorth + 0.6, kPavement, 0.5 * kPi});
    street_lamp(m, {x - 6, kRoadSouth - 0.6, kPavement, -0.5 * kPi});
  }
  traffic_light(m, {38.6, kRoadSouth - 0.5, kPavement, 0});
  traffic_light(m, {43.4, kRoadNorth + 0.5, kPavement, kPi});
  for (const double x : {8.0, 22.0, 56.0}) traffic_sign(m, {x, kRoadSouth - 0.5, kPavement, 0});
  for (const double x : {18.0, 36.0, 72.0}) traffic_sign(m, {x, kRoadNorth + 0.5, kPavement, kPi});
  for (const double x : {20.0, 45.0}) bin(m, {x, kRoadNorth + 0.7, kPavement, 0});
  for (double x = 48; x < 53; x += 1.3)
    m.cylinder({x, kRoadSouth - 0.45, kPavement, 0}, 0.06, 0.06, 0.9, 8, Material::kPole);
}

void green(Mesh& m) {
  picket_fence(m, {kWest + 0.5, kGreen + 0.2, kPavement, 0}, 7.8);
  picket_fence(m, {16.0, kGreen + 0.2, kPavement, 0}, 23.0);
  m.box({53.8, kGreen + 0.3, 0, 0}, 21.0, 0.35, 1.3, Material::kStoneWall);
  m.box({53.8, kGreen + 0.3, 1.3, 0}, 21.1, 0.45, 0.08, Material::kConcrete);
  hedge(m, {71.7, 33.0, kPavement, 0}, 6.0, 1.2, 5);
  hedge(m, {27.0, 37.6, kPavement, 0}, 9.0, 1.1, 6);
  const Eigen::Vector2d trees[] = {{9, 29},  {20, 28.5}, {27, 31}, {34, 28}, {48, 29},   {56, 31},   {62, 28},
                                   {71, 29}, {9, 40.5},  {21, 41}, {33, 40}, {52, 40.5}, {59, 39.5}, {72, 41}};
  std::uint64_t seed = 900;
  for (const Eigen::Vector2d& at : trees) street_tree(m, {at.x(), at.y(), kPavement, 0}, ++seed);
  for (const double x : {24.0, 36.0, 55.0}) bench(m, {x, 33.5, kPavement, 0.5 * kPi});
  for (const double x : {18.5, 62.0}) street_lamp(m, {x, 37.0, kPavement, 0.5 * kPi});
}

std::vector<Eigen::Vector2d> meeting_places() {
  std::vector<Eigen::Vector2d> places;
  for (double x = 8; x < 75; x += 6.5) {
    places.emplace_back(x, 35.3);      // the path across the green
    places.emplace_back(x, 22.7);      // the north pavement
    places.emplace_back(x + 2, 18.0);  // the road
  }
  for (const double x : {14.0, 41.0, 66.0}) {
    places.emplace_back(x, 27.5);
    places.emplace_back(x, 41.5);
  }
  for (const double x : {41.0, 25.0, 60.0}) places.emplace_back(x, 11.6);  // the south pavement
  return places;
}

}  // namespace

World street() {
  World world;
  Mesh& m = world.mesh;
  ground(m);
  houses(m);
  parked(m);
  along_the_road(m);
  green(m);
  world.open_air = true;
  world.flight = {2.0, 4.0};
  world.inner_size = {kEast - kWest, kNorthFront - kSouthFront, 11.2};
  world.places = meeting_places();
  world.ground = level;
  return world;
}

}  // namespace cairn::simulator::scenes
