// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/scenes.hpp"
#include "tools/simulator/scenes/street_furniture.hpp"
#include "tools/simulator/scenes/vehicles.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kPi = std::numbers::pi;
// From south to north: houses, pavement, road, tracks in grass, platform and square, houses. Houses close both ends.
constexpr double kWest = 4.0, kEast = 64.0, kSouthFront = 8.0, kRoadSouth = 13.0, kRoadNorth = 20.0, kSquare = 26.0,
                 kNorthFront = 42.0;
constexpr double kTrack = 23.0, kPlatform = 0.2;  // middle of the track; height of the platform

void strip(Mesh& m, double y0, double y1, Material material) {
  m.quad({kWest, y0, 0}, {kEast, y0, 0}, {kEast, y1, 0}, {kWest, y1, 0}, material);
}

void ground(Mesh& m) {
  strip(m, kSouthFront, kRoadSouth, Material::kPavement);
  strip(m, kRoadSouth, kRoadNorth, Material::kAsphalt);
  strip(m, kRoadNorth, kSquare, Material::kGrass);
  strip(m, kSquare, kNorthFront, Material::kPavement);
  for (const double x : {16.0, 52.0})  // where one crosses
    m.quad({x - 2.5, kRoadNorth, 0.004}, {x + 2.5, kRoadNorth, 0.004}, {x + 2.5, kSquare, 0.004},
           {x - 2.5, kSquare, 0.004}, Material::kPavement);
  for (const double side : {-0.72, 0.72})
    m.box({0.5 * (kWest + kEast), kTrack + side, 0, 0}, kEast - kWest, 0.06, 0.02, Material::kMetal);
}

void houses(Mesh& m) {
  const Material walls[] = {Material::kRender, Material::kBrick, Material::kRender, Material::kBrick,
                            Material::kConcrete};
  for (int i = 0; i < 5; ++i) {
    const double x = kWest + 6.0 + 12.0 * i, height = 8.0 + 0.7 * (i * 3 % 4);
    house(m, {{x, kSouthFront, 0, -0.5 * kPi}, 12, 8.0, height, walls[i], 3, 2.4});
    house(m, {{x, kNorthFront, 0, 0.5 * kPi}, 12, 8.0, height + 0.9, walls[4 - i], 3, 2.6});
  }
  house(m, {{kWest, 25.0, 0, kPi}, kNorthFront - kSouthFront, 3.2, 8.2, Material::kBrick, 3, 3.0});
  house(m, {{kEast, 25.0, 0, 0}, kNorthFront - kSouthFront, 3.2, 8.6, Material::kRender, 3, 2.8});
}

/// A roof on posts with a back of glass, open towards the track.
void shelter(Mesh& m, const Placement& p) {
  for (const double x : {-1.9, 1.9})
    for (const double y : {-0.6, 0.6}) m.cylinder(p.at(x, y), 0.05, 0.05, 2.3, 8, Material::kPole);
  m.box(p.at(0, 0, 2.3), 4.4, 1.7, 0.1, Material::kConcrete);
  m.box(p.at(0, 0.6, 0.3), 3.6, 0.02, 1.8, Material::kGlass);
}

void stop(Mesh& m) {
  tram(m, {33.0, kTrack, 0.02, 0});
  m.box({33.0, kSquare + 0.2, 0, 0}, 28.0, 2.6, kPlatform, Material::kKerb);
  for (const double x : {26.0, 40.0}) shelter(m, {x, kSquare + 0.7, kPlatform, 0});
  for (const double x : {21.0, 45.0}) traffic_sign(m, {x, kSquare - 0.7, kPlatform, 0});
  for (const double x : {30.0, 36.0}) bench(m, {x, kSquare + 0.9, kPlatform, 0.5 * kPi});
  for (const double x : {10.0, 22.0, 46.0, 58.0})
    m.cylinder({x, kRoadNorth + 0.6, 0, 0}, 0.09, 0.07, 6.5, 10, Material::kPole);
}

/// Two wait at the light, three have met on the square, two wait where one crosses the track.
void cyclists(Mesh& m) {
  const Placement all[] = {{48.2, 18.6, 0, 0.0},  {48.6, 17.3, 0, 0.1},  {20.5, 34.0, 0, 0.6}, {22.6, 35.2, 0, 3.6},
                           {21.0, 36.2, 0, -1.0}, {51.2, 27.2, 0, -1.5}, {52.6, 27.4, 0, -1.7}};
  for (const Placement& p : all) cyclist(m, p);
}

void along_the_road(Mesh& m) {
  traffic_light(m, {49.5, kRoadSouth - 0.5, 0, 0});
  traffic_light(m, {54.5, kRoadNorth + 0.5, 0, kPi});
  for (const double x : {12.0, 30.0, 60.0}) street_lamp(m, {x, kRoadSouth - 0.6, 0, -0.5 * kPi});
  car(m, {10.0, kRoadSouth + 1.3, 0, 0}, CarKind::kSedan, Material::kCarPaintLight);
  car(m, {23.5, kRoadSouth + 1.3, 0, 0}, CarKind::kHatchback, Material::kCarPaintDark);
  car(m, {36.0, kRoadSouth + 1.3, 0, 0}, CarKind::kVan, Material::kCarPaintLight);
  bus(m, {31.0, kRoadNorth - 1.6, 0, kPi});
}

void square(Mesh& m) {
  const Eigen::Vector2d trees[] = {{12, 33}, {29, 37}, {43, 36}, {58, 33}};
  std::uint64_t seed = 700;
  for (const Eigen::Vector2d& at : trees) street_tree(m, {at.x(), at.y(), 0, 0}, ++seed);
  for (const double x : {16.0, 34.0}) bench(m, {x, 38.5, 0, 0.5 * kPi});
  for (int i = 0; i < 5; ++i) bicycle(m, {47.0 + 0.75 * i, 39.8, 0, 0.5 * kPi + 0.05 * (i % 3)});
  hedge(m, {36.0, 31.5, 0, 0}, 7.0, 1.1, 8);
}

std::vector<Eigen::Vector2d> meeting_places() {
  std::vector<Eigen::Vector2d> places;
  for (double x = 8; x < 62; x += 7.0) {
    places.emplace_back(x, 30.0);        // the square, along the platform
    places.emplace_back(x + 2.5, 34.3);  // the square
    places.emplace_back(x + 1, 10.8);    // the south pavement
    places.emplace_back(x + 3, 16.5);    // the road
  }
  for (const double x : {16.0, 52.0}) places.emplace_back(x, 23.0);  // on the track
  return places;
}

}  // namespace

World tramstop() {
  World world;
  Mesh& m = world.mesh;
  ground(m);
  houses(m);
  stop(m);
  cyclists(m);
  along_the_road(m);
  square(m);
  world.open_air = true;
  world.flight = {2.0, 4.0};
  world.inner_size = {kEast - kWest, kNorthFront - kSouthFront, 11.0};
  world.places = meeting_places();
  world.ground = [](double, double) { return 0.0; };
  return world;
}

}  // namespace cairn::simulator::scenes
