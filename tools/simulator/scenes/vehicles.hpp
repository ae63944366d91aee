// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulator/world/mesh.hpp"

/// What drives or is parked. Fronts are at +x of the placement; the placement is on the ground below the middle.
namespace cairn::simulator::scenes {

enum class CarKind { kSedan, kHatchback, kVan };

void car(Mesh& mesh, const Placement& p, CarKind kind, Material paint);
void bus(Mesh& mesh, const Placement& p);    ///< 11.5 × 2.5 × 3 m
void truck(Mesh& mesh, const Placement& p);  ///< 7.5 × 2.4 × 3.3 m, with a tarpaulin
void tram(Mesh& mesh, const Placement& p);   ///< 22 × 2.4 × 3.4 m, in two parts
void bicycle(Mesh& mesh, const Placement& p);
void motorcycle(Mesh& mesh, const Placement& p);
void cyclist(Mesh& mesh, const Placement& p);  ///< stands astride a bicycle and waits

}  // namespace cairn::simulator::scenes
