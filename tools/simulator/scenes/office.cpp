// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <numbers>

#include "tools/simulator/scenes/office_rooms.hpp"
#include "tools/simulator/scenes/scenes.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator::scenes {
namespace {

// From south to north: rooms, corridor, rooms | rooms, corridor, rooms | rooms, corridor, rooms. Cross corridors at the
// west end, in the middle and at the east end.
constexpr double kLength = 50.0, kWidth = 40.0, kHeight = 3.0;
constexpr double kWestEnd = 2.4, kMiddleWest = 23.8, kMiddleEast = 26.2, kEastEnd = 47.6;
constexpr double kPi = std::numbers::pi;

/// A row of equal rooms along x with doors in the wall y = `door_y`; `inward` is +1 when the rooms lie north of it.
struct Row {
  double x0, x1;
  int rooms;
  double door_y, inward, depth;
};

constexpr std::array<Row, 10> kRows{{{0, kLength, 10, 6.0, -1, 6.0},
                                     {kWestEnd, kMiddleWest, 4, 8.4, 1, 6.0},
                                     {kMiddleEast, kEastEnd, 4, 8.4, 1, 6.0},
                                     {kWestEnd, kMiddleWest, 4, 18.8, -1, 4.4},
                                     {kMiddleEast, kEastEnd, 4, 18.8, -1, 4.4},
                                     {kWestEnd, kMiddleWest, 4, 21.2, 1, 4.4},
                                     {kMiddleEast, kEastEnd, 4, 21.2, 1, 4.4},
                                     {kWestEnd, kMiddleWest, 4, 31.6, -1, 6.0},
                                     {kMiddleEast, kEastEnd, 4, 31.6, -1, 6.0},
                                     {0, kLength, 10, 34.0, 1, 6.0}}};

RoomKind draw_kind(Random& random) {
  const double draw = random.uniform();
  if (draw < 0.55) return RoomKind::kTwoDesks;
  if (draw < 0.75) return RoomKind::kFourDesks;
  if (draw < 0.87) return RoomKind::kMeeting;
  return draw < 0.94 ? RoomKind::kStore : RoomKind::kLounge;
}

/// The n-th room of a row; neighbours are mirror images, as architects like them.
Room make_room(const Row& row, int n, Random& random) {
  const double width = (row.x1 - row.x0) / row.rooms;
  Room room;
  room.door_wall = {row.x0 + (n + 0.5) * width, row.door_y, 0, 0.5 * kPi * row.inward};
  room.width = width - 0.12;
  room.depth = row.depth - 0.06;
  room.door_at = (n % 2 == 0 ? 1.0 : -1.0) * row.inward * (0.5 * width - 1.05);
  room.door_angle = random.uniform() < 0.2 ? 0.0 : random.uniform(1.5, 1.62);
  room.kind = draw_kind(random);
  return room;
}

void row_walls(Mesh& m, const Row& row, const std::vector<Room>& rooms) {
  const double width = (row.x1 - row.x0) / row.rooms;
  std::vector<Opening> doors;
  for (const Room& room : rooms) {
    const Placement door = room.door_wall.at(0, room.door_at);
    doors.push_back({door.x - row.x0, kDoorWidth, 0, kDoorHead});
  }
  wall(m, {{row.x0, row.door_y}, {row.x1, row.door_y}, kHeight}, doors);
  for (int n = 0; n <= row.rooms; ++n) {
    const double x = row.x0 + n * width;
    wall(m, {{x, row.door_y + 0.06 * row.inward}, {x, row.door_y + row.inward * row.depth}, kHeight});
  }
}

/// Outer walls; the long ones with a window in every room.
void outer_walls(Mesh& m) {
  std::vector<Opening> windows;
  for (int n = 0; n < 10; ++n) windows.push_back({2.5 + 5.0 * n, 2.8, 0.9, 2.3});
  for (const double y : {-0.1, kWidth + 0.1}) {
    const Wall outer{{0, y}, {kLength, y}, kHeight, 0.2};
    wall(m, outer, windows);
    for (const Opening& w : windows) {
      const double x0 = w.at - 0.5 * w.width, x1 = w.at + 0.5 * w.width;
      m.quad({x0, y, w.sill}, {x1, y, w.sill}, {x1, y, w.head}, {x0, y, w.head}, Material::kGlass);
      m.box(on_wall(outer, w.at, w.sill), 0.06, 0.08, w.head - w.sill, Material::kDoorFrame);
    }
  }
  for (const double x : {-0.1, kLength + 0.1}) wall(m, {{x, -0.2}, {x, kWidth + 0.2}, kHeight, 0.2});
}

void corridor_furniture(Mesh& m) {
  constexpr std::array<double, 3> kCorridors{7.2, 20.0, 32.8};
  for (const double y : kCorridors) {
    for (double x = 3.0; x < 49; x += 4.0) lamp(m, {x, y, kHeight, 0}, 1.2, 0.2);
  }
  for (const double y : {13.0, 27.0}) {
    for (const double x : {1.2, 25.0, 48.8}) lamp(m, {x, y, kHeight, 0}, 0.2, 1.2);
  }
  m.box({25.0, 14.7, 0, 0}, 0.5, 0.5, kHeight, Material::kConcrete);  // columns of the structure
  m.box({25.0, 25.3, 0, 0}, 0.5, 0.5, kHeight, Material::kConcrete);
  cabinet(m, {0.3, 12.5, 0, kPi}, 1.8, 1.3);
  cabinet(m, {49.7, 27.2, 0, 0}, 1.2, 1.9);
  m.box({0.4, 24.0, 0, 0}, 0.7, 1.4, 1.15, Material::kPaint);    // printer
  m.box({49.7, 14.6, 0, 0}, 0.35, 0.35, 1.1, Material::kMetal);  // water
  plant(m, {0.45, 33.4, 0, 0}, 1.7);
  plant(m, {49.5, 6.6, 0, 0}, 1.5);
  plant(m, {26.0, 20.9, 0, 0}, 1.4);
}

std::vector<Eigen::Vector2d> corridor_places() {
  std::vector<Eigen::Vector2d> places;
  for (const double y : {7.2, 20.0, 32.8}) {
    for (const double x : {1.3, 7.0, 13.0, 19.0, 24.8, 31.0, 37.0, 43.0, 48.7}) places.emplace_back(x, y);
  }
  return places;
}

}  // namespace

World office() {
  World world;
  Mesh& m = world.mesh;
  Random random(0x0ff1ce);
  m.quad({0, 0, 0}, {kLength, 0, 0}, {kLength, kWidth, 0}, {0, kWidth, 0}, Material::kCarpet);
  m.quad({0, 0, kHeight}, {kLength, 0, kHeight}, {kLength, kWidth, kHeight}, {0, kWidth, kHeight}, Material::kCeiling);
  outer_walls(m);
  world.places = corridor_places();
  for (const Row& row : kRows) {
    std::vector<Room> rooms;
    for (int n = 0; n < row.rooms; ++n) rooms.push_back(make_room(row, n, random));
    row_walls(m, row, rooms);
    for (const Room& room : rooms) {
      furnish(m, room);
      if (room.door_angle > 0) world.places.push_back(standing_place(room));
    }
  }
  for (const double y : {14.4, 25.6}) {  // between rooms that stand back to back
    wall(m, {{kWestEnd, y}, {kMiddleWest, y}, kHeight});
    wall(m, {{kMiddleEast, y}, {kEastEnd, y}, kHeight});
  }
  corridor_furniture(m);
  world.inner_size = {kLength, kWidth, kHeight};
  world.ground = [](double, double) { return 0.0; };
  return world;
}

}  // namespace cairn::simulator::scenes
