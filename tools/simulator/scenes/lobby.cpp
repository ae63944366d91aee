// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/scenes.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kLength = 40.0, kWidth = 15.0, kHeight = 3.0;
constexpr double kPi = std::numbers::pi;

/// Glass between posts, with two revolving doors' worth of frame.
void glass_front(Mesh& m) {
  constexpr double kPitch = 2.5, kPost = 0.12;
  for (double x = 0; x < kLength - 0.01; x += kPitch) {
    m.box({x + 0.5 * kPost, -0.06, 0, 0}, kPost, 0.2, kHeight, Material::kMetal);
    m.quad({x + kPost, 0, 0.15}, {x + kPitch, 0, 0.15}, {x + kPitch, 0, 2.6}, {x + kPost, 0, 2.6}, Material::kGlass);
    m.box({x + 0.5 * (kPitch + kPost), 0, 0, 0}, kPitch - kPost, 0.1, 0.15, Material::kMetal);
    m.box({x + 0.5 * (kPitch + kPost), 0, 2.6, 0}, kPitch - kPost, 0.1, 0.4, Material::kPlaster);
  }
  for (const double x : {13.6, 21.2}) {
    m.cylinder({x, 0.9, 0, 0}, 0.04, 0.04, 2.4, 8, Material::kMetal);
    for (int i = 0; i < 4; ++i) {
      const Placement wing{x, 0.9, 0, 0.4 + 0.5 * kPi * i};
      m.box(wing.at(0.45, 0, 0.05), 0.85, 0.03, 0.25, Material::kMetal);
      m.box(wing.at(0.45, 0, 2.1), 0.85, 0.03, 0.3, Material::kMetal);
      m.box(wing.at(0.88, 0, 0.05), 0.04, 0.06, 2.3, Material::kMetal);
    }
    m.cylinder({x, 0.9, 2.45, 0}, 1.05, 1.05, 0.12, 24, Material::kMetal);
  }
}

/// The back wall with three lift recesses, a corridor mouth and two doors.
void back_wall(Mesh& m) {
  const Wall back{{0, kWidth + 0.1}, {kLength, kWidth + 0.1}, kHeight, 0.2, Material::kPlaster};
  const Opening openings[] = {{4.0, 1.1},          {11.0, 1.3, 0, 2.3}, {13.4, 1.3, 0, 2.3},
                              {15.8, 1.3, 0, 2.3}, {23.5, 3.0, 0, 2.6}, {34.0, 1.1}};
  wall(m, back, openings);
  for (const double x : {11.0, 13.4, 15.8}) {
    door_frame(m, {x, kWidth + 0.1, 0, 0}, 1.3, 2.3, 0.2);
    m.box({x, kWidth + 0.25, 0, 0}, 1.4, 0.06, 2.35, Material::kMetal);
    m.box({x + 1.0, kWidth - 0.01, 1.05, 0}, 0.1, 0.04, 0.25, Material::kScreen);
  }
  for (const double x : {4.0, 34.0}) {
    door_frame(m, {x, kWidth + 0.1, 0, 0}, 1.1, 2.1, 0.2);
    door_leaf(m, {x, kWidth + 0.16, 0, 0}, 1.1, 2.1, false, 0.0);
  }
  // The corridor behind the mouth ends after 2 m.
  m.quad({22, kWidth + 0.3, 0}, {25, kWidth + 0.3, 0}, {25, kWidth + 2.2, 0}, {22, kWidth + 2.2, 0},
         Material::kStoneFloor);
  m.quad({22, kWidth, 2.62}, {25, kWidth, 2.62}, {25, kWidth + 2.2, 2.62}, {22, kWidth + 2.2, 2.62},
         Material::kCeiling);
  wall(m, {{21.95, kWidth}, {21.95, kWidth + 2.2}, 2.62, 0.1});
  wall(m, {{25.05, kWidth}, {25.05, kWidth + 2.2}, 2.62, 0.1});
  wall(m, {{21.9, kWidth + 2.25}, {25.1, kWidth + 2.25}, 2.62, 0.1});
}

void reception(Mesh& m) {
  for (int i = 0; i < 9; ++i) {
    const double angle = -0.9 + 0.2 * i;
    const Placement segment{29.5 + 3.0 * std::cos(angle + kPi), 11.5 - 3.0 * std::sin(angle), 0, kPi - angle};
    m.box(segment, 0.5, 0.66, 1.08, Material::kWood);
    m.box(segment.at(0.05, 0, 1.08), 0.7, 0.66, 0.04, Material::kStoneFloor);
  }
  office_chair(m, {28.4, 11.4, 0, kPi});
  office_chair(m, {28.7, 12.9, 0, kPi + 0.6});
  monitor(m, {27.3, 11.9, 1.12, kPi});
  cabinet(m, {30.4, 11.5, 0, 0}, 3.2, 1.2);
  m.box({30.7, 11.5, 0, 0}, 0.15, 4.5, 2.6, Material::kWood);
}

void seats(Mesh& m) {
  for (const double x : {4.5, 9.0, 33.5}) {
    sofa(m, {x - 1.3, 4.0, 0, 0}, 1.9);
    sofa(m, {x + 1.3, 4.0, 0, kPi}, 1.9);
    round_table(m, {x, 4.0, 0, 0}, 0.4, 0.45);
    plant(m, {x, 5.6, 0, 0}, 1.7);
  }
  sofa(m, {38.9, 9.0, 0, kPi}, 2.4);
  sofa(m, {36.2, 14.4, 0, -0.5 * kPi}, 2.4);
  for (const double x : {17.5, 19.3}) round_table(m, {x, 12.3, 0, 0}, 0.35, 1.1);
  m.box({20.6, 14.55, 0, 0}, 0.95, 0.8, 1.85, Material::kMetal);  // vending machines
  m.box({19.6, 14.55, 0, 0}, 0.9, 0.75, 1.75, Material::kScreen);
  for (const double x : {1.0, 26.1, 39.2}) plant(m, {x, 14.2, 0, 0}, 2.0);
}

/// Two rows of columns, alternately round and square, and the ticket gates between the halves.
void columns_and_gates(Mesh& m) {
  for (int i = 0; i < 6; ++i) {
    const double x = 4.2 + 6.4 * i;
    m.cylinder({x, 2.4, 0, 0}, 0.3, 0.3, kHeight, 20, Material::kConcrete);
    m.box({x, 10.2, 0, 0}, 0.5, 0.5, kHeight, Material::kConcrete);
  }
  for (int i = 0; i < 3; ++i) m.box({24.2, 4.2 + 1.55 * i, 0, 0}, 1.4, 0.25, 1.0, Material::kMetal);
  m.box({12.8, 6.4, 0, 0.5}, 0.12, 1.0, 2.0, Material::kScreen);  // information pillars
  m.box({20.1, 7.9, 0, -0.3}, 0.12, 1.0, 2.0, Material::kScreen);
  m.box({6.5, 12.4, 0, 0}, 3.6, 0.1, 1.6, Material::kWood);  // exhibition boards
  m.box({7.5, 13.4, 0, 0.5 * kPi}, 1.6, 0.1, 1.6, Material::kWood);
}

void stairs(Mesh& m) {
  for (int i = 0; i < 14; ++i) {
    m.box({34.6 + 0.29 * i, 11.6, 0, 0}, 0.3, 1.9, 0.18 * (i + 1), Material::kConcrete);
  }
  for (const double y : {10.63, 12.57}) m.box({36.5, y, 0, 0}, 4.1, 0.05, 2.75, Material::kPaint);
}

}  // namespace

World lobby() {
  World world;
  Mesh& m = world.mesh;
  m.quad({0, -0.2, 0}, {kLength, -0.2, 0}, {kLength, kWidth + 0.3, 0}, {0, kWidth + 0.3, 0}, Material::kStoneFloor);
  m.quad({0, -0.2, kHeight}, {kLength, -0.2, kHeight}, {kLength, kWidth, kHeight}, {0, kWidth, kHeight},
         Material::kCeiling);
  for (const double x : {-0.1, kLength + 0.1}) wall(m, {{x, 0}, {x, kWidth + 0.2}, kHeight, 0.2});
  glass_front(m);
  back_wall(m);
  reception(m);
  seats(m);
  columns_and_gates(m);
  stairs(m);
  for (int i = 0; i < 24; ++i) lamp(m, {3.3 + 4.8 * (i % 8), 3.0 + 4.5 * (i / 8), kHeight, 0}, 1.2, 0.3);
  world.inner_size = {kLength, kWidth, kHeight};
  world.places = {{2.0, 7.5},  {1.8, 11.5}, {6.8, 8.0},   {10.0, 12.6}, {13.2, 12.8}, {15.0, 4.5}, {17.4, 7.6},
                  {13.6, 8.8}, {22.0, 5.5}, {23.5, 12.5}, {22.3, 9.8},  {26.6, 7.3},  {27.2, 3.6}, {31.0, 7.4},
                  {32.5, 9.0}, {37.0, 7.2}, {37.2, 3.2},  {32.6, 13.8}, {19.0, 3.8},  {10.2, 7.0}};
  world.ground = [](double, double) { return 0.0; };
  return world;
}

}  // namespace cairn::simulator::scenes
