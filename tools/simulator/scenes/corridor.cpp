// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/furniture.hpp"
#include "tools/simulator/scenes/scenes.hpp"

namespace cairn::simulator::scenes {
namespace {

constexpr double kLength = 20.0, kWidth = 5.0, kHeight = 3.0;

/// One long wall of coplanar panels: plaster, interrupted by flush doors.
void panelled_wall(Mesh& mesh, double y, std::initializer_list<double> doors) {
  constexpr double kDoorWidth = 1.0, kDoorHead = 2.1;
  const auto panel = [&](double x0, double x1, double z0, double z1, Material m) {
    mesh.quad({x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}, m);
  };
  double done = 0;
  for (const double at : doors) {
    panel(done, at, 0, kHeight, Material::kPlaster);
    panel(at, at + kDoorWidth, 0, kDoorHead, Material::kDoor);
    panel(at, at + kDoorWidth, kDoorHead, kHeight, Material::kPlaster);
    done = at + kDoorWidth;
  }
  panel(done, kLength, 0, kHeight, Material::kPlaster);
}

/// Something that runs along the whole corridor, without end faces: they would mark the ends of the long axis.
void rail(Mesh& mesh, double y, double width, double z0, double z1, Material m) {
  const double y0 = y - 0.5 * width, y1 = y + 0.5 * width;
  for (const double z : {z0, z1}) mesh.quad({0, y0, z}, {kLength, y0, z}, {kLength, y1, z}, {0, y1, z}, m);
  for (const double side : {y0, y1})
    mesh.quad({0, side, z0}, {kLength, side, z0}, {kLength, side, z1}, {0, side, z1}, m);
}

}  // namespace

World corridor() {
  World world;
  Mesh& m = world.mesh;
  m.quad({0, 0, 0}, {kLength, 0, 0}, {kLength, kWidth, 0}, {0, kWidth, 0}, Material::kStoneFloor);
  m.quad({0, 0, kHeight}, {kLength, 0, kHeight}, {kLength, kWidth, kHeight}, {0, kWidth, kHeight}, Material::kCeiling);
  panelled_wall(m, 0, {3.2, 8.4, 15.1});
  panelled_wall(m, kWidth, {5.5, 12.7});
  for (const double x : {0.0, kLength}) {
    m.quad({x, 0, 0}, {x, kWidth, 0}, {x, kWidth, kHeight}, {x, 0, kHeight}, Material::kDarkGlass);
  }
  for (const double side : {-1.0, 1.0}) {
    rail(m, 0.5 * kWidth + side * (0.5 * kWidth - 0.01), 0.02, 0.0, 0.1, Material::kWood);  // skirting board
    rail(m, 0.5 * kWidth + side * 1.9, 0.3, 2.72, 2.84, Material::kMetal);                  // cable tray
  }
  rail(m, 0.5 * kWidth, 0.18, 2.9, 2.98, Material::kPaint);  // lamps in one line
  world.inner_size = {kLength, kWidth, kHeight};
  world.places = {{1.8, 2.5}, {4.0, 1.7}, {6.5, 3.2}, {9.0, 2.3}, {11.0, 1.8}, {13.0, 3.1}, {15.5, 2.0}, {18.2, 2.6}};
  world.ground = [](double, double) { return 0.0; };
  return world;
}

}  // namespace cairn::simulator::scenes
