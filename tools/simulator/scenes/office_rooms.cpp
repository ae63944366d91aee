// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/office_rooms.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kPi = std::numbers::pi;

/// Things are never quite where the plan has them; the room's own position is the seed.
class Jitter {
 public:
  explicit Jitter(const Placement& p)
      : random_(static_cast<std::uint64_t>(std::llround(97 * p.x)),
                static_cast<std::uint64_t>(std::llround(89 * p.y))) {}
  Placement operator()(const Placement& p, double shift, double turn) {
    return p.at(random_.uniform(-shift, shift), random_.uniform(-shift, shift), 0, random_.uniform(-turn, turn));
  }
  double between(double low, double high) { return random_.uniform(low, high); }

 private:
  Random random_;
};

void workplace(Mesh& m, const Placement& p, Jitter& jitter) {
  desk(m, p);
  monitor(m, jitter(p.at(0.15, 0.1, 0.74), 0.08, 0.25));
  office_chair(m, jitter(p.at(-0.62, 0), 0.12, 0.6));
}

/// +1 when the door is in the left half of its wall: the layout is mirrored so that the door side stays free.
double mirror(const Room& room) { return room.door_at > 0 ? -1.0 : 1.0; }

void desks(Mesh& m, const Room& room, int rows) {
  Jitter jitter(room.door_wall);
  const Placement& o = room.door_wall;
  const double s = mirror(room), half = 0.5 * room.width;
  for (int row = 0; row < rows; ++row) {
    const double x = room.depth - 0.55 - 2.1 * row;
    workplace(m, o.at(x, s * (half - 1.05)), jitter);
    if (row == 0) workplace(m, o.at(x, s * (half - 2.85)), jitter);
  }
  cabinet(m, o.at(0.95, s * (half - 0.3), 0, s * 0.5 * kPi), 0.9, jitter.between(1.1, 1.9));
  shelf(m, o.at(room.depth - 1.9, -s * (half - 0.26), 0, -s * 0.5 * kPi), 1.2, 1.9);
  bin(m, jitter(o.at(0.35, s * (half - 1.2)), 0.1, 0));
  radiator(m, o.at(room.depth - 0.13, 0), 1.4);
}

void meeting(Mesh& m, const Room& room) {
  Jitter jitter(room.door_wall);
  const double s = mirror(room), half = 0.5 * room.width;
  const Placement centre = room.door_wall.at(room.depth - 1.6, s * 0.45);
  table(m, centre, 1.2, 2.6);
  for (int i = 0; i < 3; ++i) {
    office_chair(m, jitter(centre.at(-0.8, -0.85 + 0.85 * i), 0.08, 0.4));
    office_chair(m, jitter(centre.at(0.85, -0.85 + 0.85 * i, 0, kPi), 0.08, 0.4));
  }
  m.box(room.door_wall.at(room.depth - 1.6, s * (half - 0.09), 0.9), 1.8, 0.03, 1.1, Material::kPaint);
  m.box(room.door_wall.at(room.depth - 1.6, -s * (half - 0.1), 1.1), 1.3, 0.05, 0.75, Material::kScreen);
}

void store(Mesh& m, const Room& room) {
  const double s = mirror(room), half = 0.5 * room.width;
  for (double x = 0.9; x < room.depth - 0.8; x += 1.25) {
    shelf(m, room.door_wall.at(x, s * (half - 0.26), 0, s * 0.5 * kPi), 1.2, 2.2);
  }
  for (double y = -half + 0.8; y < half - 1.0; y += 1.25) {
    shelf(m, room.door_wall.at(room.depth - 0.26, y), 1.2, 2.2);
  }
  m.box(room.door_wall.at(room.depth - 1.7, -s * (half - 0.45)), 0.7, 0.65, 1.15, Material::kPaint);  // copier
}

void lounge(Mesh& m, const Room& room) {
  Jitter jitter(room.door_wall);
  const double s = mirror(room), half = 0.5 * room.width;
  m.box(room.door_wall.at(room.depth - 0.38, 0), 0.62, room.width - 0.3, 0.9, Material::kWood);
  m.box(room.door_wall.at(room.depth - 0.26, s * 0.8, 1.45), 0.36, 2.4, 0.65, Material::kWood);
  m.box(room.door_wall.at(room.depth - 1.3, s * (half - 0.4)), 0.62, 0.62, 1.8, Material::kPaint);  // refrigerator
  sofa(m, room.door_wall.at(1.4, s * (half - 0.55), 0, -s * 0.5 * kPi), 1.7);
  const Placement corner = room.door_wall.at(room.depth - 1.9, s * 0.5);
  round_table(m, corner, 0.45, 0.74);
  for (int i = 0; i < 3; ++i) office_chair(m, jitter(corner.at(0, 0, 0, 2.1 * i + 0.5).at(-0.75, 0), 0.05, 0.3));
  plant(m, room.door_wall.at(room.depth - 1.1, -s * (half - 0.45)), 1.6);
}

void door(Mesh& m, const Room& room) {
  // The frame's x axis runs along the wall and its y axis into the room. The hinge is near the side wall.
  const Placement at = room.door_wall.at(0, room.door_at, 0, -0.5 * kPi);
  door_frame(m, at, kDoorWidth, kDoorHead, 0.12);
  door_leaf(m, at.at(0, 0.03), kDoorWidth, kDoorHead, room.door_at < 0, room.door_angle);
}

}  // namespace

void furnish(Mesh& m, const Room& room) {
  door(m, room);
  switch (room.kind) {
    case RoomKind::kTwoDesks:
      desks(m, room, 1);
      break;
    case RoomKind::kFourDesks:
      desks(m, room, 2);
      break;
    case RoomKind::kMeeting:
      meeting(m, room);
      break;
    case RoomKind::kStore:
      store(m, room);
      break;
    case RoomKind::kLounge:
      lounge(m, room);
      break;
  }
  lamp(m, room.door_wall.at(0.5 * room.depth, 0, 3.0), 1.3, 0.35);
}

Eigen::Vector2d standing_place(const Room& room) {
  const Placement p = room.door_wall.at(1.75, 0.85 * room.door_at);
  return {p.x, p.y};
}

}  // namespace cairn::simulator::scenes
