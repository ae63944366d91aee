// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "tools/simulator/world/mesh.hpp"

/// What stands in buildings and car parks. Every body stands at its placement: x is its front-to-back axis, and what a
/// user of it faces (screen, back rest, wall) is on the +x side unless it says otherwise. Metres.
namespace cairn::simulator::scenes {

struct Opening {
  double at;  ///< of its centre, from the wall's start
  double width;
  double sill = 0;    ///< height of the lower edge; 0 = a door
  double head = 2.1;  ///< height of the upper edge
};

/// An upright wall of `thickness`, centred on the line from → to, with openings in order along it.
struct Wall {
  Eigen::Vector2d from, to;
  double height = 3.0;
  double thickness = 0.12;
  Material material = Material::kPlaster;
};
void wall(Mesh& mesh, const Wall& w, std::span<const Opening> openings = {});
/// The placement on the wall's line, `along` metres from its start, x pointing along the wall.
[[nodiscard]] Placement on_wall(const Wall& w, double along, double up = 0);

/// Frame of a door opening, proud of a wall of `thickness`; x of the placement runs along the wall.
void door_frame(Mesh& mesh, const Placement& at, double width, double head, double thickness);
/// A leaf hinged at the left or right end of the opening, `angle` open (radians; positive swings towards +y).
void door_leaf(Mesh& mesh, const Placement& at, double width, double head, bool hinge_right, double angle);

void desk(Mesh& mesh, const Placement& p);          ///< 0.8 deep, 1.6 wide; a user sits on the −x side
void office_chair(Mesh& mesh, const Placement& p);  ///< back rest on the −x side
void monitor(Mesh& mesh, const Placement& p);       ///< stands on a desk
void cabinet(Mesh& mesh, const Placement& p, double width, double height);
void shelf(Mesh& mesh, const Placement& p, double width, double height);  ///< open boards with some boxes
void table(Mesh& mesh, const Placement& p, double length, double width);
void round_table(Mesh& mesh, const Placement& p, double radius, double height);
void sofa(Mesh& mesh, const Placement& p, double width);  ///< back rest on the −x side
void radiator(Mesh& mesh, const Placement& p, double width);
void plant(Mesh& mesh, const Placement& p, double height);
void bin(Mesh& mesh, const Placement& p);
void lamp(Mesh& mesh, const Placement& p, double length, double width);  ///< hangs below the placement
/// Small random leaves filling an ellipsoid with the given half axes around the placement. `seed` fixes them.
void leaves(Mesh& mesh, const Placement& centre, double half_x, double half_y, double half_z, int count, double size,
            std::uint64_t seed);

}  // namespace cairn::simulator::scenes
