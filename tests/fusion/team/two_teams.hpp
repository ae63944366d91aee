// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fusion/team/team.hpp"

namespace cairn::fleet {

inline team::TeamConfig team_member(peers::RobotId id, double resolution_m = 0.2) {
  team::TeamConfig config;
  config.id = id;
  config.name = "robot_" + std::to_string(id);
  config.resolution_m = resolution_m;
  return config;
}

/// So many tiles in a row, each with a wall.
inline void say_walls(team::Team& team, unsigned tiles, Time now) {
  mapping::TileState wall;
  for (unsigned i = 0; i < 64; ++i) wall.set(i % 8, 3, i / 8, 2);
  for (unsigned i = 0; i < tiles; ++i)
    team.observe(mapping::TileKey::of_voxel(static_cast<std::uint16_t>(32768 + 8 * i), 32768, 32768), wall, now);
}

/// Both talk for so long, ten times a second, over a link that loses nothing.
inline void talk(team::Team& a, team::Team& b, Time& now, Duration length) {
  for (const Time end = now + length; now < end; now += std::chrono::milliseconds(100)) {
    std::vector<peers::Outgoing> from_a, from_b;
    a.step(now, from_a);
    b.step(now, from_b);
    for (const auto& datagram : from_a) (void)b.receive(datagram.bytes, now);
    for (const auto& datagram : from_b) (void)a.receive(datagram.bytes, now);
  }
}

}  // namespace cairn::fleet
