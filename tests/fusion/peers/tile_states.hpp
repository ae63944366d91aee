// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// Tiles of all kinds: alike throughout, walls, noise of any density.
inline mapping::TileState random_tile_state(std::mt19937& random) {
  mapping::TileState state;
  const auto value = [&] { return std::uniform_real_distribution<float>(-2, 3.5F)(random); };
  const auto kind = static_cast<unsigned>(random() % 4), density = static_cast<unsigned>(1 + random() % 30);
  const float alike = value();
  for (unsigned z = 0; z < 8; ++z)
    for (unsigned y = 0; y < 8; ++y)
      for (unsigned x = 0; x < 8; ++x) {
        if (kind == 0)
          state.set(x, y, z, alike);
        else if (kind == 1 && x <= density % 8)
          state.set(x, y, z, x == density % 8 ? value() : -2.0F);
        else if (kind >= 2 && random() % density == 0)
          state.set(x, y, z, value());
      }
  if (state.empty()) state.set(0, 0, 0, -2);
  return state;
}

/// Labels for some of its occupied voxels, of up to so many kinds.
inline mapping::TileState with_labels(mapping::TileState state, std::mt19937& random, unsigned kinds) {
  std::vector<mapping::VoxelLabel> labels(512);
  for (std::size_t i = 0; i < 512; ++i) {
    const unsigned drawn = static_cast<unsigned>(random());
    if ((state.occupied[i / 64] >> (i % 64) & 1U) != 0 && drawn % 3 != 0)
      labels[i].code = static_cast<std::uint8_t>(1 + drawn / 3 % kinds);
  }
  state.set_labels(labels);
  return state;
}

/// A wall, somewhat rough, with free space on one side of it and nothing known behind: what most tiles look like.
inline mapping::TileState wall_tile_state(std::mt19937& random) {
  mapping::TileState state;
  const auto draw = [&](unsigned below) { return static_cast<unsigned>(random() % below); };
  const unsigned at = 1 + draw(6), from = draw(3), to = 6 + draw(3);
  for (unsigned z = from; z < to; ++z)
    for (unsigned y = 0; y < 8; ++y) {
      for (unsigned x = 0; x < at; ++x) state.set(x, y, z, draw(12) == 0 ? -0.4F : -1.6F);
      if (draw(8) != 0) state.set(at, y, z, mapping::TileState::kOccupied[draw(4)]);
    }
  return state;
}

}  // namespace cairn::peers
