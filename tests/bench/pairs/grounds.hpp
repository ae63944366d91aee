// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/simulator/world/world.hpp"

namespace cairn::pairs {

/// Kinds of places.
enum class Kind {
  kRooms,  ///< a floor of rooms and corridors, 32 to 48 × 20 to 30 m
  /// A hall with pillars, a stage and rows of seats, 24 to 45 × 16 to 30 m. With a seed that 4 divides,
  /// it is symmetric but for its furniture.
  kHall,
  kOutdoor,  ///< houses, trees and cars on rolling ground, 80 m
  kTown,     ///< the same, 400 m
};

/// A place, as the seed says. Its `places` are where a robot may stop.
[[nodiscard]] simulator::World make_ground(Kind kind, std::uint64_t seed);

/// A furnished room behind a door. `room` decides the room, `outside` what is beyond the door.
[[nodiscard]] simulator::World make_room(std::uint64_t room, std::uint64_t outside);

/// Adds `count` boxes of about `size_m` beside the places at which robots stop.
void add_objects(simulator::World& world, int count, double size_m, std::uint64_t seed);

}  // namespace cairn::pairs
