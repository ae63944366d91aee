// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/simulator/world/world.hpp"

namespace cairn::missions {

/// Which parts of a building are copies of others.
enum class Copies {
  kNone,      ///< every room has its own size, door and furniture
  kRooms,     ///< all rooms alike, furniture included; the corridors differ
  kHalfTurn,  ///< the second half is the first, turned by 180°, but for a few boxes
};

/// A floor of 32 to 48 × 20 to 30 × 3 m: a corridor along it, another across, and rooms with doors
/// on both sides. Places of the world are the rooms' middles and points of the corridors. The seed
/// decides everything but the kind.
[[nodiscard]] simulator::World make_building(Copies copies, std::uint64_t seed);

}  // namespace cairn::missions
