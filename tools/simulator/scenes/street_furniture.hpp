// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tools/simulator/world/mesh.hpp"

/// What stands beside a road. Signs, lights and lamps face −x of their placement: against the traffic that comes.
namespace cairn::simulator::scenes {

void street_lamp(Mesh& mesh, const Placement& p);    ///< 6 m, the arm reaches to −x
void traffic_sign(Mesh& mesh, const Placement& p);   ///< round, 2.2 m above the ground
void traffic_light(Mesh& mesh, const Placement& p);  ///< three lamps
void street_tree(Mesh& mesh, const Placement& p, std::uint64_t seed);
void hedge(Mesh& mesh, const Placement& p, double length, double height, std::uint64_t seed);  ///< along x
void picket_fence(Mesh& mesh, const Placement& from, double length);                           ///< along x
void bench(Mesh& mesh, const Placement& p);                                                    ///< looks towards −x

struct House {
  Placement front;  ///< in the middle of the façade on the ground; x points into the house
  double width = 12, depth = 8, height = 9;
  Material walls = Material::kBrick;
  int storeys = 3;
  double bay = 2.6;  ///< m from window to window
};
/// A block with windows and a door in its façade and a tiled roof with eaves.
void house(Mesh& mesh, const House& house);

}  // namespace cairn::simulator::scenes
