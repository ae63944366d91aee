// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulator/world/world.hpp"

/// One function per scene: it draws the mesh, names the places and gives the ground. Layouts use fixed seeds.
namespace cairn::simulator::scenes {

/// 20 × 5 × 3 m. Nothing in it tells how far along one is: smooth walls, flush doors, and dark glass at both ends that
/// returns nothing. For a LiDAR the long axis is degenerate, as in the corridors that real robots get lost in.
[[nodiscard]] World corridor();
/// 20 × 5 × 3 m, too, with what corridors have: doors set back in thick walls, pillars, radiators, closed ends.
[[nodiscard]] World hallway();
/// 40 × 15 × 3 m entrance hall: columns, reception, seats, plants, lifts, a glass front.
[[nodiscard]] World lobby();
/// 50 × 40 × 3 m office floor: three parallel corridors, three cross corridors and 52 rooms that look much alike.
[[nodiscard]] World office();
/// 48 × 32 × 2.8 m parking deck: columns, beams, kerbs, parked cars, a ramp and a stairwell.
[[nodiscard]] World carpark();
/// 60 × 60 m of sloping, undulating forest floor with trees, bushes, rocks and fallen logs.
[[nodiscard]] World forest();
/// 80 × 56 m of a town in the open air: a street between houses with everything that is parked and stands there, and a
/// campus green with paths, trees, fence and wall. 17 of the 19 Cityscapes classes, people included.
[[nodiscard]] World street();
/// 60 × 34 m of a town: a tram stands at its stop between a road and a square, and cyclists wait. Of Cityscapes'
/// classes it has what the street lacks: train and rider. The riders are part of the world, as all that stands.
[[nodiscard]] World tramstop();

}  // namespace cairn::simulator::scenes
