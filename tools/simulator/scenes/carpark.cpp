// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/scenes.hpp"
#include "tools/simulator/scenes/vehicles.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kLength = 48.0, kWidth = 32.0, kHeight = 2.8;
constexpr double kBay = 2.5, kFirstBay = 0.5;
constexpr double kPi = std::numbers::pi;

/// Bays along x at `y`; cars stand nose in (towards +y when `nose` is +1).
void bays(Mesh& m, double x0, double x1, double y, double nose, Random& random) {
  for (double x = x0 + 0.5 * kBay; x < x1 - 0.4 * kBay; x += kBay) {
    const bool taken = random.uniform() < 0.62;
    const double heading = 0.5 * kPi * (random.uniform() < 0.8 ? nose : -nose) + random.uniform(-0.04, 0.04);
    const Placement place{x + random.uniform(-0.15, 0.15), y + random.uniform(-0.25, 0.25), 0, heading};
    const CarKind kind = random.uniform() < 0.2   ? CarKind::kVan
                         : random.uniform() < 0.5 ? CarKind::kSedan
                                                  : CarKind::kHatchback;
    const Material paint = random.uniform() < 0.55 ? Material::kCarPaintLight : Material::kCarPaintDark;
    if (taken) car(m, place, kind, paint);
    m.box({x, y + nose * 2.45, 0, 0}, 1.8, 0.15, 0.11, Material::kConcrete);  // wheel stop
  }
}

void columns_and_beams(Mesh& m) {
  for (int i = 0; i < 6; ++i) {
    const double x = kFirstBay + kBay + 7.5 * i;  // between bays
    for (const double y : {5.3, 13.15, 18.85, 26.7}) {
      if (y < 6 && x > 35) continue;  // the ramp is there
      m.box({x, y, 0, 0}, 0.4, 0.6, kHeight, Material::kConcrete);
      m.box({x, y, 0, 0}, 0.44, 0.64, 1.0, Material::kPaint);
    }
    m.box({x, 0.5 * kWidth, kHeight - 0.4, 0}, 0.4, kWidth, 0.4, Material::kConcrete);
  }
  for (const double y : {8.6, 23.4}) {
    for (double x = 2; x < kLength; x += 4) lamp(m, {x, y, kHeight - 0.05, 0}, 1.4, 0.15);
    m.box({0.5 * kLength, y + 1.2, 2.25, 0}, kLength - 1.0, 0.2, 0.15, Material::kMetal);  // pipes
  }
}

/// Up to the next deck, between two walls, along the south-east edge.
void ramp(Mesh& m) {
  constexpr double kFrom = 35.0, kTo = 47.0, kNorth = 4.6, kSouth = 0.6;
  m.quad({kFrom, kSouth, 0.01}, {kTo, kSouth, 2.0}, {kTo, kNorth, 2.0}, {kFrom, kNorth, 0.01}, Material::kConcrete);
  m.quad({kTo, kSouth, 0}, {kTo, kNorth, 0}, {kTo, kNorth, 2.0}, {kTo, kSouth, 2.0}, Material::kConcrete);
  for (const double y : {kSouth - 0.1, kNorth + 0.1}) {
    m.box({0.5 * (kFrom + kTo), y, 0, 0}, kTo - kFrom, 0.2, 1.1, Material::kConcrete);
    m.box({0.5 * (kFrom + kTo) + 3.0, y, 1.1, 0}, kTo - kFrom - 6.0, 0.2, 1.69, Material::kConcrete);
  }
}

void stairwell_and_islands(Mesh& m) {
  m.box({2.6, 16.0, 0, 0}, 3.4, 4.2, kHeight, Material::kPlaster);
  door_frame(m, {4.3, 16.0, 0, 0.5 * kPi}, 1.2, 2.1, 0.06);
  m.box({4.31, 16.0, 0.02, 0}, 0.04, 1.06, 2.03, Material::kDoor);
  m.box({4.75, 14.2, 0, 0}, 0.5, 0.9, 1.75, Material::kPaint);  // pay station
  for (const double y : {16.0}) {
    for (const double x : {8.0, 44.6}) {
      m.box({x, y, 0, 0}, 2.4, 3.0, 0.13, Material::kKerb);
      m.cylinder({x + (x < 20 ? 0.9 : -0.9), y, 0.13, 0}, 0.06, 0.06, 1.0, 10, Material::kPole);
      m.cylinder({x + (x < 20 ? 0.9 : -0.9), y, 1.13, 0}, 0.064, 0.064, 0.1, 10, Material::kRetroreflector);
    }
  }
  for (const double x : {20.0, 29.0}) {  // hanging signs
    m.box({x, 8.6, 2.1, 0}, 0.05, 1.6, 0.35, Material::kRetroreflector);
    m.box({x, 23.4, 2.1, 0}, 0.05, 1.6, 0.35, Material::kRetroreflector);
  }
}

void shell(Mesh& m) {
  m.quad({0, 0, 0}, {kLength, 0, 0}, {kLength, kWidth, 0}, {0, kWidth, 0}, Material::kAsphalt);
  m.quad({0, 0, kHeight}, {kLength, 0, kHeight}, {kLength, kWidth, kHeight}, {0, kWidth, kHeight}, Material::kConcrete);
  for (const double x : {-0.15, kLength + 0.15}) {
    wall(m, {{x, -0.3}, {x, kWidth + 0.3}, kHeight, 0.3, Material::kConcrete});
  }
  const Opening gates[] = {{31.5, 4.5, 0, 2.4}};
  wall(m, {{0, -0.15}, {kLength, -0.15}, kHeight, 0.3, Material::kConcrete}, gates);
  m.quad({29.25, -0.1, 0}, {33.75, -0.1, 0}, {33.75, -0.1, 2.4}, {29.25, -0.1, 2.4}, Material::kMetal);  // shutter
  // Parapet with open air above: nothing returns from there.
  wall(m, {{0, kWidth + 0.15}, {kLength, kWidth + 0.15}, 1.1, 0.3, Material::kConcrete});
  for (double x = 0.3; x < kLength; x += 7.9) m.box({x, kWidth + 0.15, 1.1, 0}, 0.6, 0.3, 1.7, Material::kConcrete);
}

}  // namespace

World carpark() {
  World world;
  Mesh& m = world.mesh;
  Random random(0xca45);
  shell(m);
  columns_and_beams(m);
  ramp(m);
  stairwell_and_islands(m);
  bays(m, kFirstBay, 28.0, 2.75, -1, random);
  bays(m, kFirstBay + 4 * kBay, 43.0, 13.2, 1, random);
  bays(m, kFirstBay + 4 * kBay, 43.0, 18.8, -1, random);
  bays(m, kFirstBay, 48.0, 29.2, 1, random);
  world.inner_size = {kLength, kWidth, kHeight};
  world.places = {{3.0, 8.4},   {9.0, 7.6},   {15.0, 8.9},  {21.0, 7.5},  {27.0, 9.0},  {33.0, 8.0},  {39.5, 8.3},
                  {46.2, 9.5},  {46.8, 14.5}, {46.6, 20.0}, {45.6, 23.6}, {39.0, 22.8}, {33.0, 24.3}, {27.0, 22.9},
                  {21.0, 24.1}, {15.0, 23.2}, {9.0, 24.0},  {5.4, 22.0},  {5.8, 11.5},  {31.5, 4.0}};
  world.ground = [](double, double) { return 0.0; };
  return world;
}

}  // namespace cairn::simulator::scenes
